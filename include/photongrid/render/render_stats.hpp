// What a render did: every photon and every millisecond accounted for. The program writes it as JSON (--stats).
#pragma once

#include <photongrid/render/image.hpp>
#include <photongrid/scene/render_settings.hpp>
#include <photongrid/trace/photon_stats.hpp>
#include <photongrid/trace/render_observer.hpp>

#include <cstdint>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// The photon map that was built.
struct map_stats {
    map_builder builder = map_builder::sort; ///< sorted or routed (2.2)
    std::uint64_t cells = 0;                 ///< of the whole grid
    glm::uvec3 resolution{0};                ///< cells along each axis
    std::uint64_t overflowing_cells = 0;     ///< routed cells with more photons than slots
    double redistributed_power = 0;          ///< W, rgb together: flux of photons not kept, given to those kept
    std::uint64_t sort_steps = 0;            ///< not counted: 0; stage_stats::passes has the passes of the sort
    std::uint64_t left_out = 0; ///< photons stored, but of a part of the light that was not asked for (light_part)
};

/// One of the four stages of the paper's Table 1.
struct stage_stats {
    double ms = 0;                  ///< without compiling kernels
    double compile_ms = 0;          ///< compiling those that the stage needed first
    std::uint64_t passes = 0;       ///< run on the device
    std::uint64_t device_bytes = 0; ///< largest amount held in buffers during the stage
};

/// The searches behind a picture, all eye rays together.
struct estimate_stats {
    double mean_count = 0;    ///< photons used by an estimate
    double mean_radius = 0;   ///< m
    double mean_visited = 0;  ///< photons looked at
    std::uint64_t points = 0; ///< that photons were sought for
};

/// What build_map and draw did: the numbers of `--stats`.
struct render_stats {
    photon_stats photons;                ///< of the map, whichever view is drawn
    map_stats map;                       ///< what build_map made
    stage_stats trace_photons;           ///< 2.1
    stage_stats build_map;               ///< 2.2
    stage_stats trace_rays;              ///< eye rays and direct light (2.4)
    stage_stats radiance_estimate;       ///< 2.3
    estimate_stats estimate;             ///< how many photons it took, and how far away
    std::uint64_t invalid_pixels = 0;    ///< NaN or infinite before they were set to 0
    std::uint64_t peak_device_bytes = 0; ///< most that buffers held at once since the backend was made
};

/// A picture, and what it took.
struct rendered {
    image picture;
    render_stats stats;
};

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
