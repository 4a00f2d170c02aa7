// How a picture comes about that is watched, where it is, and what is needed to go on with it. Plain data.
#pragma once

#include <photongrid/scene.hpp>

#include <cstdint>
#include <string_view>
#include <vector>

namespace photongrid {

/// A picture drawn before the picture: pixels of divisor x divisor, and estimates from k / fewer photons. Both make it
/// noisier, not darker.
struct first_look {
    uint divisor = 1; ///< side of its pixels, in the picture's
    uint fewer = 1;   ///< by which k is divided; 8 photons are sought at least, where k is not less
};

/// What a picture that is not finished has so far; progressive_view::resume goes on from there.
struct view_state {
    uint rays = 0;                   ///< eye rays a pixel, each way through glass apart, that `pixels` has
    std::vector<glm::vec4> pixels;   ///< their share of the radiance, W/(m^2 sr)
    std::vector<glm::vec4> searches; ///< sums over their searches: photons used, radius, photons visited, searches
    std::vector<glm::vec4> errors;   ///< x: sum of relative errors; empty unless render_settings::aov
};

/// How a picture that is watched begins: with fewer photons where tracing all takes long, larger pixels and smaller k,
/// so that its first look takes about as long as it should, by what the last ones took. The picture's end does not
/// depend on it.
struct first_looks {
    bool wanted = true;    ///< false: nothing is shown before the picture itself
    double target_ms = 40; ///< of the first map, and of the first look from it
};

/// What a progressive_render does now.
struct render_progress {
    std::string_view stage;       ///< "trace_photons", "build_map", "first_looks", "radiance_estimate", "finished"
    double fraction = 0;          ///< of the stage, 0 to 1
    std::uint64_t unfinished = 0; ///< pixels whose estimates are not done
    uint divisor = 1;             ///< of the look in flight: side of its pixels, in the picture's
    uint photons = 0;             ///< of the map in use or being made
};

} // namespace photongrid
