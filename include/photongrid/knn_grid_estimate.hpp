// The kNN-grid radiance estimate (section 2.3, figure 6): at least k nearest photons, found in concentric sets of cells, a
// bounded amount of work a pass, the answer so far readable after any pass.
#pragma once

#include <photongrid/photon_map.hpp>

namespace photongrid {

/// What to search for.
struct knn_settings {
    uint k = 50;              ///< photons wanted; all within max_radius are taken when there are fewer
    float max_radius = 0;     ///< m; photons farther away are always rejected. 0 or less: nothing is found
    float min_radius = 0;     ///< m; the disc of the estimate is never smaller. 0: 2^-20 of the grid's largest extent
    /// Photons that one query examines in a pass at most, and ranges of the list that it opens. Any values give the same
    /// result. 16 lanes x (visits + ranges) must stay below 65,535, after which llvmpipe and lavapipe end loops in silence.
    uint visits_per_pass = 3072;
    uint ranges_per_pass = 1023;
};

/// Estimates per query point, in buffers.
template <backend B>
struct knn_estimates {
    buffer_of<B, glm::vec4> irradiance; ///< rgb, W/m^2: flux / (pi r^2); w: r^2, m^2
    buffer_of<B, glm::uvec2> used;      ///< x: photons used, y: photons visited
};

/// A search for many points at once, that can be advanced, looked at and advanced again.
///
/// The photons used are exactly those at a distance d with d^2 <= r^2 (in float, as the kernel computes it), at least
/// min(k, those within max_radius) of them. With fewer than k, r is max_radius. Radiance of a Lambertian surface is
/// irradiance x reflectance / pi.
template <backend B>
class knn_search {
public:
    /// Points: xyz in m; w > 0 marks a point that wants an estimate. `map` and `points` must outlive the search.
    /// \throws std::invalid_argument for a radius that is NaN.
    knn_search(B& b, const photon_map<B>& map, const buffer_of<B, glm::vec4>& points, const knn_settings& s)
        : b_(&b), map_(&map), points_(&points), settings_(s), gathered_(b.template make<glm::vec4>(points.size())),
          found_(b.template make<glm::uvec4>(points.size())), cursor_(b.template make<glm::uvec4>(points.size()))
    {
        if (std::isnan(s.max_radius) || std::isnan(s.min_radius))
            throw std::invalid_argument("knn_search: max_radius, min_radius: NaN");
        if (s.visits_per_pass < 1 || s.ranges_per_pass < 2)
            throw std::invalid_argument("knn_search: visits_per_pass, ranges_per_pass: need at least 1 and 2, or a pass gets nowhere");
        const grid& g = map.cells_of;
        if (!(settings_.min_radius > 0)) {
            const auto extent = glm::vec3(g.cell) * glm::vec3(g.resolution);
            settings_.min_radius = std::max(extent.x, std::max(extent.y, extent.z)) * 0x1p-20f;
        }
        const bool searching = map.photons.size() > 0 && s.k > 0 && s.max_radius > 0;
        b.template run<kernels::knn_start>(points.size(), {.grid = g, .searching = searching ? 1u : 0u}, reads(points), writes(gathered_, found_, cursor_));
    }

    /// Runs at most `passes` more passes over the points not yet done.
    progress advance(uint passes = nowhere)
    {
        const photon_map<B>& m = *map_;
        return b_->template run_until_done<kernels::knn_visit>(
            {points_->size(), 0u, m.contiguous ? 1u : 0u},
            {.grid = m.cells_of, .wanted = settings_.k, .max_radius2 = max_radius2(), .visits = settings_.visits_per_pass, .ranges = settings_.ranges_per_pass},
            reads(*points_, m.cells, m.list, m.photons.positions, m.photons.powers), writes(gathered_, found_, cursor_), passes);
    }

    /// The estimates from what is held now: the running ones (3.4), or the final ones when the search has finished.
    knn_estimates<B> estimates()
    {
        knn_estimates<B> e{b_->template make<glm::vec4>(points_->size()), b_->template make<glm::uvec2>(points_->size())};
        b_->template run<kernels::knn_result>(points_->size(), {.wanted = settings_.k, .max_radius2 = max_radius2(), .min_radius2 = settings_.min_radius * settings_.min_radius},
            reads(gathered_, found_), writes(e.irradiance, e.used));
        return e;
    }

private:
    float max_radius2() const
    {
        const float r = settings_.max_radius;
        return r > 0 ? std::min(r * r, std::numeric_limits<float>::max()) : 0.0f;
    }

    B* b_;
    const photon_map<B>* map_;
    const buffer_of<B, glm::vec4>* points_;
    knn_settings settings_;
    buffer_of<B, glm::vec4> gathered_;
    buffer_of<B, glm::uvec4> found_, cursor_;
};

/// The whole search at once: the estimate at every point, section 2.3 to the letter.
template <backend B>
knn_estimates<B> knn_grid_estimate(B& b, const photon_map<B>& map, const buffer_of<B, glm::vec4>& points, const knn_settings& settings)
{
    knn_search<B> search(b, map, points, settings);
    search.advance();
    return search.estimates();
}

} // namespace photongrid
