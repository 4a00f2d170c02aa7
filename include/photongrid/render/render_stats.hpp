// Statistics of a render: counts of photons, and times. The program writes them as JSON (--stats).
#pragma once

#include <photongrid/render/chosen_settings.hpp>
#include <photongrid/render/image.hpp>
#include <photongrid/scene/render_settings.hpp>
#include <photongrid/trace/photon_stats.hpp>
#include <photongrid/trace/render_observer.hpp>

#include <cstdint>
#include <limits>
#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The photon map that was built.
struct map_stats {
    map_builder builder = map_builder::sort; ///< how it was built; sort or blocks where the setting was automatic
    std::uint64_t blocks = 0;                ///< of a block map
    std::uint64_t cells = 0;                 ///< of the whole grid; 0 in a block map
    glm::uvec3 resolution{0};                ///< cells along each axis
    std::uint64_t overflowing_cells = 0;     ///< routed cells that received more photons than they have slots
    double redistributed_power = 0;          ///< W, rgb together: power of photons not kept, given to those kept
    std::uint64_t left_out = 0;              ///< photons stored that belong to another part of the light (light_part)
};

/// A stage: the scene's preparation, or one of the four of the paper's Table 1.
struct stage_stats {
    double ms = 0;                  ///< without the compilation of kernels
    double compile_ms = 0;          ///< compilation of kernels that the stage used first
    std::uint64_t passes = 0;       ///< passes on the device
    std::uint64_t device_bytes = 0; ///< most bytes in buffers during the stage
};

/// The searches of a picture, over all eye rays.
struct estimate_stats {
    double mean_count = 0;    ///< photons used by an estimate
    double mean_radius = 0;   ///< m
    double mean_visited = 0;  ///< photons visited
    std::uint64_t points = 0; ///< number of searches
};

/// What ended a picture: its number of passes, or a stop rule (output_settings).
enum class ended_by { nothing, passes, error, seconds };

/// The end of a picture of passes.
struct end_stats {
    std::uint32_t passes = 0; ///< in the picture
    /// Of the picture, by picture_error(); infinity: not known, as of a single pass.
    double error = std::numeric_limits<double>::infinity();
    ended_by by = ended_by::nothing;
};

/// Statistics of build_map and draw, which `--stats` writes.
struct render_stats {
    photon_stats photons;                ///< of the map, independent of the view
    map_stats map;                       ///< the map
    stage_stats prepare_scene;           ///< layout, trees and upload, once for all passes
    stage_stats trace_photons;           ///< 2.1
    stage_stats build_map;               ///< 2.2
    stage_stats trace_rays;              ///< eye rays and direct light (2.4)
    stage_stats radiance_estimate;       ///< 2.3
    estimate_stats estimate;             ///< the searches
    std::optional<pilot_measures> pilot; ///< what decided about settings that nobody gave
    end_stats end;                       ///< of render() and progressive_render
    std::uint64_t invalid_pixels = 0;    ///< pixels that were NaN or infinite before they were set to 0
    std::uint64_t peak_device_bytes = 0; ///< most bytes in buffers since the backend was created
};

/// A picture and its statistics.
struct rendered {
    image picture;
    render_stats stats;
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
