// Nearest-neighbour searches among points that are not photons: which points are near, how many, and how far away.
//
//     const photongrid::point_index index(device, points);
//     const auto nearest = index.nearest(queries, 16);
//     for (const auto& n : nearest[0])
//         use(points[n.id], n.distance2);
#pragma once

#include <photongrid/estimate/host_search.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/estimate/knn_neighbours.hpp>
#include <photongrid/map/map_builders.hpp>
#include <photongrid/map/vector_view.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A point near a query point.
struct point_neighbour {
    photon_id id = no_id; ///< its index in the range that the index was made from
    float distance2 = 0;  ///< m^2

    bool operator==(const point_neighbour&) const = default;
};

/// The neighbours of many query points; [i] has those of query point i.
class point_neighbours {
public:
    /// How many query points.
    std::size_t size() const { return begin_.size() - 1; }
    /// The neighbours of query point i.
    std::span<const point_neighbour> operator[](std::size_t i) const&
    {
        return std::span(all_).subspan(begin_[i], begin_[i + 1] - begin_[i]);
    }
    std::span<const point_neighbour> operator[](std::size_t i) const&& = delete; // the span would dangle

private:
    template <backend B>
    friend class point_index;
    std::vector<point_neighbour> all_;
    std::vector<std::size_t> begin_{0};
};

/// A host's points in a grid that is fitted to them.
///
/// nearest() and count_within() run on the device. It must outlive these calls, and one thread at a time may use it.
/// within() and the searches for one point run in the calling thread, on a copy in the host's memory; any number of
/// threads may run them at the same time. Positions in double precision are treated as in photon_map.
///
/// In all searches a radius of 0 or less finds nothing, infinity sets no limit, and NaN throws std::invalid_argument. A
/// query point that is not finite has no neighbours. No search finds points at distances above 10^19 m.
/// \snippet snippets.cpp point_index
template <backend B>
class point_index : public host_queries {
public:
    /// `k`: the number of neighbours that searches typically ask for. The grid is fitted to it; results do not depend
    /// on it.
    /// \throws std::invalid_argument for k = 0 or more than 2^32 - 1 points, backend_error where the device has no room.
    point_index(B& device, const vector_argument& points, uint k = 16);

    /// How many points the index was made from.
    uint size() const { return map_.photons.size(); }

    /// The k nearest points of each query point, nearest first; equal distances are ordered by id. Fewer if the index
    /// has fewer points within max_radius, m.
    /// \throws std::invalid_argument for k = 0 and a radius of NaN; backend_error if the device has no room.
    [[nodiscard]] point_neighbours nearest(
        const vector_argument& queries, uint k, float max_radius = std::numeric_limits<float>::infinity()) const;
    /// All points within `radius`, m, of each query point, nearest first. Lists of unknown length do not suit a kernel,
    /// so this runs in the calling thread, query point by query point; threads may divide the query points.
    /// \throws std::invalid_argument for a radius of NaN.
    [[nodiscard]] point_neighbours within(const vector_argument& queries, float radius) const;
    /// How many points lie within `radius`, m, of each query point.
    /// \throws std::invalid_argument for a radius of NaN; backend_error if the device has no room.
    [[nodiscard]] std::vector<uint> count_within(const vector_argument& queries, float radius) const;

private:
    static const vector_view& checked(const vector_view& points)
    {
        detail::check_map_size("point_index: points", points.size());
        return points;
    }

    photons<B> uploaded(B& device, const vector_view& points) const;

    B* device_;
    map_buffers<B> map_;
};

// Defined outside of the class, and not inline: see photon_map.hpp.

template <backend B>
point_index<B>::point_index(B& device, const vector_argument& points, uint k)
    : host_queries(detail::origin_of(checked(points))), device_(&device),
      map_(fitted_map(device, uploaded(device, points), k))
{
    host_ = host_search(device, map_, {.k = k}, false);
}

template <backend B>
point_neighbours point_index<B>::nearest(const vector_argument& queries, uint k, float max_radius) const
{
    B& device = *device_;
    const auto lists = knn_neighbours(
        device, map_, detail::upload_view(device, queries, origin_, 1.0f), {.k = k, .max_radius = max_radius});
    const auto ids = device.download(lists.ids);
    const auto distances2 = device.download(lists.distances2);
    point_neighbours n;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        for (std::size_t entry = i * k; entry < (i + 1) * k && ids[entry] != no_id; ++entry)
            n.all_.push_back({ids[entry], distances2[entry]});
        n.begin_.push_back(n.all_.size());
    }
    return n;
}

template <backend B>
point_neighbours point_index<B>::within(const vector_argument& queries, float radius) const
{
    detail::check_radius(radius);
    point_neighbours n;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const auto first = static_cast<std::ptrdiff_t>(n.all_.size());
        host_.for_each_within(local(queries[i]), radius, [&](photon_id id, float distance2) {
            n.all_.push_back({id, distance2});
        });
        std::sort(n.all_.begin() + first, n.all_.end(), [](const point_neighbour& a, const point_neighbour& c) {
            return a.distance2 < c.distance2 || (a.distance2 == c.distance2 && a.id < c.id);
        });
        n.begin_.push_back(n.all_.size());
    }
    return n;
}

template <backend B>
std::vector<uint> point_index<B>::count_within(const vector_argument& queries, float radius) const
{
    B& device = *device_;
    const auto points = detail::upload_view(device, queries, origin_, 1.0f);
    const float bounded = std::min(radius, std::numeric_limits<float>::max()); // NaN remains, and is refused
    const auto e = knn_grid_estimate(
        device, map_, points, {.max_radius = bounded, .search = search_kind::fixed_radius, .bias = bias_kind::paper});
    std::vector<uint> counts;
    for (const auto& used : device.download(e.used))
        counts.push_back(used.x);
    return counts;
}

template <backend B>
photons<B> point_index<B>::uploaded(B& device, const vector_view& points) const
{
    // A map needs powers, though these searches read none.
    const std::vector<glm::vec4> none(points.size());
    return {detail::upload_view(device, points, origin_, 0.0f), device.upload(std::span(none))};
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
