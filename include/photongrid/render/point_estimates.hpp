// The estimates at points on surfaces that a picture needs, in steps: their radii first, if those are given by another
// map (shrinking_radii.hpp); then the search in the photon map; then the correction of edges. Where probes find that a
// disc reaches beyond its surface, it is cut down and searched again.
#pragma once

#include <photongrid/render/disc_probes.hpp>
#include <photongrid/render/edge_correction.hpp>
#include <photongrid/render/lit_disc.kernel.hpp>
#include <photongrid/render/marked_points.hpp>
#include <photongrid/render/running_search.hpp>
#include <photongrid/render/shrinking_radii.hpp>

#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace detail {
    /// The search within the radii of points.
    inline knn_settings search_by_radii(knn_settings k)
    {
        k.search = search_kind::fixed_radius;
        k.radii_at_points = true;
        return k;
    }
} // namespace detail

/// Corrects what `search` found in a map at the edges of surfaces, as short rays find them. `points` (recentred, m; w:
/// squared radius, m^2; 0 or less: no estimate) with their unit normals.
/// \throws backend_error.
template <backend B>
void correct_by_probes(B& device, const device_scene<B>& s, const map_buffers<B>& map, const knn_settings& search,
    const buffer_of<B, glm::vec4>& points, const buffer_of<B, glm::vec4>& normals, knn_estimates<B>& found)
{
    const auto n = points.size();
    const auto probed = probe_discs(device, s, points, normals, {search.filter, search.leaks.min_cosine});
    if (const detail::marked_points<B> cut(device, probed.cut); cut.count > 0) {
        const auto [places, place_normals] = cut.gather(device, probed.points, probed.normals);
        auto halved = detail::search_by_radii(search);
        halved.half_spaces = true;
        running_search<B> again(
            device, map, places, place_normals, halved, running_estimate_kind::none, step_size::largest);
        while (!again.advance()) {}
        detail::take_estimates(device, glm::uvec2(static_cast<uint>(n), 1), probed.cut, cut, again.take(), found);
    }
    divide_by_cover(device, probed.cover, found);
}

/// What estimates at points come from. What it points to must outlive their computation.
template <backend B>
struct estimate_sources {
    const device_scene<B>* scene = nullptr;
    const map_buffers<B>* map = nullptr; ///< the photons
    first_radii<B> radii{};              ///< without a map `search` finds the radii
    double share2 = 1;                   ///< of the squared first radii: shrunk_share2 of the pass
    knn_settings search{};               ///< finds the radii
    edge_correction edges = edge_correction::none;

    /// Whether short rays find how much of each disc is on its surface.
    bool probes_edges() const
    {
        return edges == edge_correction::probes && search.leaks.min_cosine > 0 && search.max_radius > 0
            && map->photons.size() > 0;
    }
    /// The search in `map`.
    knn_settings search_in_map() const { return radii.map != nullptr ? detail::search_by_radii(search) : search; }
};

/// The estimates at some points.
template <backend B>
class point_estimates {
public:
    /// A buffer of points or normals.
    using vectors = buffer_of<B, glm::vec4>;

    /// `points` (recentred, m; w > 0: an estimate is wanted) and their unit `normals` must outlive it.
    /// \throws std::invalid_argument as knn_search does, backend_error.
    point_estimates(B& device, const estimate_sources<B>& from, const vectors& points, const vectors& normals,
        running_estimate_kind kind, step_size size);

    /// Runs a step. Returns whether the estimates are finished.
    bool advance();

    /// Whether the next step improves the estimates that are shown.
    bool is_shown() const { return search_ && search_->is_shown(); }
    /// Whether there are estimates to show.
    bool has_running_estimates() const { return search_.has_value(); }
    /// The estimates so far, for display, if there are any.
    knn_estimates<B> running_estimates() { return corrected_by_polygons(search_->running_estimates()); }
    /// The number of points whose estimates are not finished.
    std::uint64_t unfinished() const { return search_ ? search_->unfinished() : points_.size(); }

    /// The estimates. They must be finished.
    knn_estimates<B> take()
    {
        return from_.probes_edges() ? corrected_by_probes(search_->take()) : corrected_by_polygons(search_->take());
    }

private:
    knn_estimates<B> corrected_by_polygons(knn_estimates<B> found);
    knn_estimates<B> corrected_by_probes(knn_estimates<B> found);

    B& device_;
    estimate_sources<B> from_;
    const vectors& points_;
    const vectors& normals_;
    running_estimate_kind kind_;
    step_size size_;
    std::optional<running_search<B>> radius_search_; ///< in the first map
    vectors own_radii_;                              ///< the points with their radii
    std::optional<running_search<B>> search_;
};

// Defined outside the class: functions defined inside are implicitly inline, and `extern template` does not suppress
// them.

template <backend B>
point_estimates<B>::point_estimates(B& device, const estimate_sources<B>& from, const vectors& points,
    const vectors& normals, running_estimate_kind kind, step_size size)
    : device_(device), from_(from), points_(points), normals_(normals), kind_(kind), size_(size)
{
    if (from_.radii.map == nullptr) {
        search_.emplace(device_, *from_.map, points_, normals_, from_.search, kind_, size_);
        return;
    }
    auto k = from_.search;
    k.k = from_.radii.k;
    k.errors = k.biases = false;
    radius_search_.emplace(device_, *from_.radii.map, points_, normals_, k, running_estimate_kind::none, size_);
}

template <backend B>
bool point_estimates<B>::advance()
{
    if (search_)
        return search_->advance();
    if (radius_search_->advance()) {
        own_radii_ = detail::points_with_radii(
            device_, points_, radius_search_->take().irradiance, from_.share2, detail::max_radius2(from_.search));
        radius_search_.reset();
        search_.emplace(device_, *from_.map, own_radii_, normals_, from_.search_in_map(), kind_, size_);
    }
    return false;
}

template <backend B>
knn_estimates<B> point_estimates<B>::corrected_by_polygons(knn_estimates<B> found)
{
    if (from_.edges == edge_correction::polygons)
        correct_edges(device_, *from_.scene, points_, normals_, found, from_.search.filter);
    return found;
}

template <backend B>
knn_estimates<B> point_estimates<B>::corrected_by_probes(knn_estimates<B> found)
{
    const auto n = points_.size();
    const bool have_radii = from_.radii.map != nullptr;
    vectors found_radii;
    if (!have_radii)
        found_radii
            = detail::points_with_radii(device_, points_, found.irradiance, 1, detail::max_radius2(from_.search));
    auto discs = device_.template make<glm::vec4>(n);
    device_.template run<kernels::lit_disc>(
        n, {}, reads(have_radii ? own_radii_ : found_radii, found.irradiance), writes(discs));
    correct_by_probes(device_, *from_.scene, *from_.map, from_.search, discs, normals_, found);
    return found;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
