// Counts of photon paths and hits.
#pragma once

#include <cstdint>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Counts of photon paths and hits: absorbed + escaped + cut_off + invalid = emitted; stored + direct +
/// left_to_caustics + dropped = diffuse hits.
struct photon_stats {
    std::uint64_t asked = 0;   ///< photons that tracing was asked for; it stores fewer where few paths store any
    std::uint64_t emitted = 0; ///< paths, from the lights
    /// Paths ended by Russian roulette, on a light's own surface, or, for caustic photons, at the first diffuse one.
    std::uint64_t absorbed = 0;
    std::uint64_t escaped = 0;      ///< paths that left the scene (the paper's invalid mark)
    std::uint64_t cut_off = 0;      ///< paths that reached the depth limit
    std::uint64_t invalid = 0;      ///< paths that became NaN or infinite
    std::uint64_t diffuse_hits = 0; ///< hits on Lambertian surfaces
    std::uint64_t stored = 0;       ///< diffuse hits in the map
    std::uint64_t direct = 0;       ///< diffuse hits straight from a light, which shadow rays account for
    /// Diffuse hits of caustic photons on the paths to a map of other photons: caustic photons have a map of their own.
    std::uint64_t left_to_caustics = 0;
    std::uint64_t dropped = 0; ///< diffuse hits of the last path beyond the requested number of photons
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
