// What kind of estimate is wanted: which photons are sought, how they are weighted, which are refused.
#pragma once

#include <cstdint>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// Which photons an estimate uses. At a distance d from the query point, within the maximum radius, those that no leak
/// policy rejects.
enum class search_kind : std::uint8_t {
    at_least_k,   ///< section 2.3: k, and more where the radius grew too far; depends on the order of cells
    exact_k,      ///< the k nearest; of several at the k-th distance, those with the smallest ids
    fixed_radius, ///< all within the maximum radius
};

/// The weight of a photon at distance d of the radius r; each is normalised to expectation 1 over the disc.
enum class filter_kind : std::uint8_t {
    constant,     ///< 1
    cone,         ///< 1 - d/r (Jensen's with slope 1)
    epanechnikov, ///< 1 - d^2/r^2
    silverman,    ///< (1 - d^2/r^2)^2 (Silverman 1986)
};

/// What to do about the photon that sets the radius.
enum class bias_kind : std::uint8_t {
    paper,    ///< counts like any other: k / (pi r_k^2), high by k / (k - 1) for a constant kernel
    unbiased, ///< is left out of the sum; the mean is right for every kernel. No photon is left out where the radius
              ///< was given or the maximum was reached. With at_least_k a remainder is left, up to +1.7 % at k = 32
};

/// What to do about the part of an estimate's disc that hangs over the edge of its surface, where no photon can be.
enum class edge_correction : std::uint8_t {
    none,     ///< nothing: an estimate at a straight edge reads half of the truth, in a right corner a quarter
    polygons, ///< on polygons, divide by the share of the disc that is surface, weighted by the filter
              ///< (edge_correction.hpp)
};

/// Policies against light that leaks through walls and round corners. A photon that one of them rejects neither counts
/// towards k nor shrinks the radius.
struct leak_policy {
    bool side = false; ///< reject photons that arrived from behind the surface; needs directions of photons and normals
                       ///< of points
    float min_cosine
        = -1; ///< reject photons stored on a surface turned away by more than this: needs normals of both; -1: off
    float flattening = 1; ///< distances along the normal count this many times: the ball becomes a disc; needs normals
                          ///< of points; 1: off

    bool needs_normals() const { return min_cosine > -1; }                       ///< of photons
    bool needs_any() const { return side || needs_normals() || flattening > 1; } ///< of points

    bool operator==(const leak_policy&) const = default; ///< of every member
};

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
