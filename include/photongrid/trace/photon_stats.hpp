// The account of photons: no path and no hit is lost.
#pragma once

#include <cstdint>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// Where the photons went. absorbed + escaped + cut_off + invalid = emitted; stored + direct + dropped = diffuse hits.
struct photon_stats {
    std::uint64_t emitted = 0;      ///< paths, from the lights
    std::uint64_t absorbed = 0;     ///< paths ended by Russian roulette, or on a light's own surface
    std::uint64_t escaped = 0;      ///< paths that met nothing more (the paper's invalid mark)
    std::uint64_t cut_off = 0;      ///< paths still alive at the deepest bounce allowed
    std::uint64_t invalid = 0;      ///< paths that became NaN or infinite
    std::uint64_t diffuse_hits = 0; ///< times that a path met a Lambertian surface
    std::uint64_t stored = 0;       ///< diffuse hits in the map
    std::uint64_t direct = 0;       ///< diffuse hits straight from a light, left to the shadow rays
    std::uint64_t dropped = 0;      ///< diffuse hits of the last path beyond the number of photons asked for
};

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
