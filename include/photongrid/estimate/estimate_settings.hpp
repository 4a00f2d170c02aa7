// The kind of estimate: which photons are sought, how they are weighted, and which are rejected.
#pragma once

#include <photongrid/estimate/filter.hpp>

#include <cstdint>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Which photons an estimate uses: of those that no leak policy rejects, within the maximum radius.
enum class search_kind : std::uint8_t {
    at_least_k,   ///< at least k (2.3). In a grid map the radius grows cell by cell and may overshoot, so the result
                  ///< depends on the grid. In a block map it is the next of a series of radii (search_radius.glsl)
    exact_k,      ///< the k nearest; of several photons at the k-th distance, those with the smallest ids
    fixed_radius, ///< all photons within the maximum radius
};

/// Whether the photon that sets the radius counts.
enum class bias_kind : std::uint8_t {
    paper,    ///< it counts: k / (pi r_k^2), which is too high by k / (k - 1) for a constant filter
    unbiased, ///< it does not count; the mean is right for every filter. No photon is excluded if the radius was given,
              ///< the maximum radius was reached, or the photon lies within the minimum radius. With at_least_k some
              ///< bias remains, up to +1.7 % at k = 32
};

/// The correction of estimates near the edge of a surface, beyond which there are no photons.
enum class edge_correction : std::uint8_t {
    none,     ///< no correction: an estimate at a straight edge is half of the irradiance, in a right corner a quarter
    polygons, ///< on polygons, divide by the share of the disc that lies on the surface, weighted by the filter
              ///< (edge_correction.hpp)
    probes,   ///< on surfaces of every kind, by a share that short rays find (disc_probes.hpp). Discs whose radius is
              ///< known beforehand, as radii that shrink are, also end where a surface begins again behind a wall
};

/// Policies against light that leaks through walls and around corners. A rejected photon neither counts towards k nor
/// affects the radius.
struct leak_policy {
    bool side = false; ///< reject photons that arrive from behind the surface; needs photons' directions and points'
                       ///< normals
    /// Reject photons of other surfaces: those whose normal has a smaller cosine with the point's, and those that lie
    /// off the surface through the point (off_surface.glsl), as on the shelf below; needs both normals; -1: off.
    float min_cosine = -1;
    float flattening = 1; ///< factor for distances along the normal, so that the search ball becomes a flat ellipsoid;
                          ///< needs points' normals; 1: off

    bool needs_photon_normals() const { return min_cosine > -1; }
    bool needs_point_normals() const { return side || min_cosine > -1 || flattening > 1; }

    bool operator==(const leak_policy&) const = default;
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
