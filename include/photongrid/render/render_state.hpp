// Where a picture that comes about step by step is, and what is needed to go on with it. Plain data.
#pragma once

#include <photongrid/render/film.hpp>

#include <cstdint>
#include <string_view>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// What a progressive_render does now.
struct render_progress {
    std::string_view stage;       ///< "trace_photons", "build_map", "preview", "radiance_estimate", "finished"
    double fraction = 0;          ///< of the stage, 0 to 1
    std::uint64_t unfinished = 0; ///< pixels whose estimates are not done
    std::uint32_t divisor = 1;    ///< side of the pixels being drawn, in the picture's
    std::uint32_t photons = 0;    ///< of the map in use or being made
    std::uint32_t passes = 0;     ///< that are in the picture
};

/// A pass that is not finished: the light of its first rays.
struct unfinished_pass {
    std::uint32_t number = 0; ///< which pass
    std::uint32_t rays = 0;   ///< eye rays per pixel, each way through glass apart, that `light` has; 0: nothing
    pass_pixels light;        ///< so far
};

/// What a picture that is not finished has so far; progressive_render::resume goes on from there.
struct render_state {
    photongrid::film film;
    unfinished_pass pass;

    /// Nothing is lost by forgetting it.
    bool empty() const { return film.passes() == 0 && pass.rays == 0; }
};

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
