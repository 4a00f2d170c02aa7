// A photon map as a host sees it: photons of the host's in, irradiance out.
//
//     const photongrid::photon_map map(device, photons, {.k = 400});
//     for (const auto& e : map.irradiance(points, {.standard_error = true}))
//         use(e.value, e.error, e.radius, e.count);
//
// Buffers, kernels and searches that can be interrupted lie underneath: map/, estimate/.
#pragma once

#include <photongrid/estimate/host_search.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/build_map.hpp>
#include <photongrid/map/vector_view.hpp>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// What is wanted of irradiance.
struct irradiance_options {
    bool standard_error = false; ///< also how far off the values are likely to be
};

/// Photons, found again by where they are. It remembers how it is searched.
///
/// Searches for many points run on the device, which must still be there; one thread at a time may use it. Searches for
/// one point are const work of the calling thread on a copy of the map in the host's memory (see host_search): any
/// number of threads may run them at once.
///
/// Doubles are measured from the middle of the photons, so that points 10^6 m from 0 and 0.1 m apart are told apart.
/// Distances are in single precision.
/// \snippet snippets.cpp photon_map
template <backend B>
class photon_map {
public:
    /// Photons of the host's, any contiguous range that photon_reader reads; `search` says how they are searched. The
    /// grid is fitted to them.
    /// \throws std::invalid_argument for settings that make no sense, backend_error where the device has no room.
    template <std::ranges::contiguous_range Range>
    requires std::ranges::sized_range<Range> && own_photon<std::ranges::range_value_t<Range>> photon_map(
        B& device, const Range& photons, const knn_settings& search = {})
        : photon_map(device, detail::attributes_of(photons), search)
    {
    }
    /// Photons whose attributes are apart: {.positions = p, .powers = w}.
    photon_map(B& device, const photon_attributes& photons, const knn_settings& search = {})
        : device_(&device), origin_(detail::origin_of(photons.positions)),
          map_(fitted_map(device, uploaded(device, photons, origin_), std::max(search.k, 1u))),
          host_(device, map_, search, true)
    {
    }

    /// Photons that it was made from.
    uint size() const { return map_.photons.size(); }
    /// How it is searched.
    const knn_settings& search() const { return host_.settings(); }
    /// The map on the device.
    const map_buffers<B>& buffers() const& { return map_; }
    const map_buffers<B>& buffers() const&& = delete;
    /// What positions on the device are measured from.
    const glm::dvec3& origin() const { return origin_; }

    /// Irradiance at many points, in their order.
    /// \throws backend_error where the device has no room.
    [[nodiscard]] std::vector<irradiance_at_point> irradiance(
        const vector_view& points, const irradiance_options& options = {}) const
    {
        return searched(points, nullptr, options);
    }
    /// With the unit normal of the surface at each point, which leak policies need.
    [[nodiscard]] std::vector<irradiance_at_point> irradiance(
        const vector_view& points, const vector_view& normals, const irradiance_options& options = {}) const
    {
        return searched(points, &normals, options);
    }
    /// Irradiance at one point, with its standard error. From any thread, each with a scratch of its own.
    /// \throws std::invalid_argument where the search is at_least_k.
    template <detail::vector_like V, detail::vector_like N>
    [[nodiscard]] irradiance_at_point irradiance(const V& point, const N& normal, query_scratch& scratch) const
    {
        return host_.irradiance(local(point), detail::to_vec3(normal), scratch);
    }

    /// Calls f(photon_id, float distance2) for every photon within `radius`, m, in no particular order. From any
    /// thread.
    template <detail::vector_like V, class F>
    void for_each_within(const V& point, float radius, const F& f) const
    {
        host_.for_each_within(local(point), radius, f);
    }
    /// The same for the k nearest, nearest first; of equally near ones, the smallest id first. From any thread.
    template <detail::vector_like V, class F>
    void for_each_nearest(const V& point, uint k, query_scratch& scratch, const F& f) const
    {
        host_.for_each_nearest(local(point), k, std::numeric_limits<float>::infinity(), scratch, f);
    }
    /// With a scratch that each thread keeps.
    template <detail::vector_like V, class F>
    void for_each_nearest(const V& point, uint k, const F& f) const
    {
        thread_local query_scratch scratch;
        for_each_nearest(point, k, scratch, f);
    }

private:
    static photons<B> uploaded(B& b, const photon_attributes& a, const glm::dvec3& origin)
    {
        const auto check = [&](const char* name, std::size_t n, bool may_lack) {
            if (n != a.positions.size() && !(may_lack && n == 0))
                throw std::invalid_argument(std::string("photon_map: ") + name + ": " + std::to_string(n)
                    + " elements for " + std::to_string(a.positions.size()) + " photons; each needs one");
        };
        check("powers", a.powers.size(), false);
        check("directions", a.directions.size(), true);
        check("normals", a.normals.size(), true);
        if (a.positions.size() > std::numeric_limits<uint>::max())
            throw std::invalid_argument(
                "photon_map: photons: " + std::to_string(a.positions.size()) + " are more than 2^32 - 1");
        const glm::dvec3 zero(0);
        return {detail::upload_view(b, a.positions, origin, 0.0f), detail::upload_view(b, a.powers, zero, 0.0f),
            detail::upload_view(b, a.directions, zero, 0.0f), detail::upload_view(b, a.normals, zero, 0.0f)};
    }

    template <class V>
    glm::vec3 local(const V& point) const
    {
        return glm::vec3(detail::to_dvec3(point) - origin_);
    }

    std::vector<irradiance_at_point> searched(
        const vector_view& points, const vector_view* normals, const irradiance_options& options) const
    {
        B& b = *device_;
        auto s = search();
        s.errors = options.standard_error;
        const auto device_points = detail::upload_view(b, points, origin_, 1.0f);
        const auto estimates = [&] {
            if (normals == nullptr)
                return knn_grid_estimate(b, map_, device_points, s);
            const auto surface_normals = detail::upload_view(b, *normals, glm::dvec3(0), 0.0f);
            return knn_grid_estimate(b, map_, device_points, surface_normals, s);
        }();
        const auto values = b.download(estimates.irradiance), errors = b.download(estimates.standard_error);
        const auto used = b.download(estimates.used);
        std::vector<irradiance_at_point> all(values.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            all[i] = {.value = glm::vec3(values[i]), .radius = std::sqrt(values[i].w), .count = used[i].x};
            if (options.standard_error) {
                all[i].error = glm::vec3(errors[i]);
                all[i].error_of_sum = errors[i].w;
            }
        }
        return all;
    }

    B* device_;
    glm::dvec3 origin_;
    map_buffers<B> map_;
    host_search host_;
};

template <backend B, class Range>
photon_map(B&, const Range&, const knn_settings&) -> photon_map<B>;
template <backend B, class Range>
photon_map(B&, const Range&) -> photon_map<B>;
template <backend B>
photon_map(B&, const photon_attributes&, const knn_settings&) -> photon_map<B>;
template <backend B>
photon_map(B&, const photon_attributes&) -> photon_map<B>;

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
