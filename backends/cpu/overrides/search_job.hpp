// The parameters of the search's SIMD code: plain pointers, because it is compiled once per instruction set.
#pragma once

#include <photongrid/backends/cpu/buffer.hpp>
#include <photongrid/estimate/estimate_settings.hpp>
#include <photongrid/estimate/gather_photons.kernel.hpp>
#include <photongrid/map/map_buffers.hpp>

#include <span>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::cpu {

/// A search for many points, and the arrays for its results.
struct search_job {
    grid cells_of{};
    std::span<const glm::uvec2> cells;
    soa_vectors<const float> boxes;                                  ///< of a block map
    uint levels = 0;                                                 ///< of a block map's tree; 0: a grid map
    uint in_blocks = 0;                                              ///< photons of a block map in blocks
    soa_vectors<const float> positions, powers, directions, normals; ///< the last two only if a policy needs them
    const uint* list = nullptr;
    const glm::vec4* points = nullptr;
    const glm::vec4* point_normals = nullptr; ///< only if a policy or biases need them
    const uint* order = nullptr;              ///< order of the points; it should keep neighbours in space together

    search_kind search = search_kind::exact_k;
    bool searching = true;        ///< false: nothing can be found
    uint k = 0;                   ///< photons sought
    bool radii_at_points = false; ///< fixed_radius: the w of a point is its squared radius, m^2
    float max_radius2 = 0;        ///< m^2
    float min_radius2 = 0;        ///< m^2; see least_disc2 (search_radius.glsl)
    bool side = false;            ///< leak policies, see photon_distance.glsl
    bool needs_photon_normals = false;
    float min_cosine = -1;
    float flattening = 0;     ///< c^2 - 1
    bool half_spaces = false; ///< points may have half spaces in the w of their normals (half_space.glsl)
    filter_kind filter = filter_kind::constant;
    float norm = 1;         ///< of the filter
    bool leave_out = false; ///< exclude the photon that sets the radius
    bool errors = false;
    bool repeats = false; ///< the map may hold a photon several times, as often as the w of its power says

    glm::vec4* irradiance = nullptr;
    glm::uvec2* used = nullptr;
    glm::vec4* standard_error = nullptr; ///< only with errors
    struct bias_places {
        glm::vec4 *bias = nullptr, *tilt = nullptr, *jump = nullptr, *constant = nullptr;
    } biases;              ///< null, or where biases are stored (estimate_biases)
    float bias_factor = 0; ///< of the filter
    bool in_plane = false; ///< offsets are projected to the surface: point_normals are there

    uint* ids = nullptr;         ///< if not null, lists are made instead of estimates: k entries per point here ...
    float* distances2 = nullptr; ///< ... and here
};

} // namespace photongrid::cpu

#include <photongrid/core/exact_end.hpp>
