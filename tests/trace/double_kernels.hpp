// The serial kernels compiled with double in place of float.
#pragma once

#include "../estimate/estimator_tests.hpp"
#include "ray_tests.hpp"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdouble-promotion" // literals keep their suffix f
#endif

namespace photongrid::double_kernels {

using glm::abs, glm::floor, glm::max, glm::min, glm::sqrt;
using glm::uvec2, glm::uvec4;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
using photongrid::uint;

/// For is_finite3: infinite and NaN stay so.
inline uint floatBitsToUint(double x) { return glm::floatBitsToUint(static_cast<float>(x)); }
inline double uintBitsToFloat(uint bits) { return static_cast<double>(glm::uintBitsToFloat(bits)); }

#include <photongrid/core/begin.hpp>
#include <photongrid/core/natural_exp.kernel.hpp>
#include <photongrid/core/natural_log.kernel.hpp>
#include <photongrid/map/grid.kernel.hpp>
#include <photongrid/trace/emission_guide.kernel.hpp>
#include <photongrid/trace/photon_event.kernel.hpp>
#include <photongrid/trace/ray_state.kernel.hpp>
#include <photongrid/trace/ray_tests.kernel.hpp>
#include <photongrid/trace/scene_layout.kernel.hpp>
#define float double

// What kernels share, too.
#undef PHOTONGRID_INSIDE_KERNEL_STRUCT
#include <photongrid/core/natural_exp.glsl>
#include <photongrid/core/natural_log.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/core/vector.glsl>
#include <photongrid/estimate/gather_tally.glsl>
#include <photongrid/estimate/half_space.glsl>
#include <photongrid/estimate/row_cursor.glsl>
#include <photongrid/estimate/search_radius.glsl>
#include <photongrid/estimate/search_tally.glsl>
#include <photongrid/map/block_tree.glsl>
#include <photongrid/map/grid.glsl>
#include <photongrid/trace/emission_guide.glsl>
#include <photongrid/trace/photon_event.glsl>
#include <photongrid/trace/ray_state.glsl>
#include <photongrid/trace/ray_tests.glsl>
#include <photongrid/trace/scene_layout.glsl>
#define PHOTONGRID_INSIDE_KERNEL_STRUCT

struct ray_probe {
#include "probes/ray_probe.glsl"
};
struct glass_probe {
#include "probes/glass_probe.glsl"
};
struct emit_photon {
#include <photongrid/trace/emit_photon.glsl>
};
struct bounce_photon {
#include <photongrid/trace/bounce_photon.glsl>
};
struct gather_start {
#include <photongrid/estimate/gather_start.glsl>
};
struct gather_photons {
#include <photongrid/estimate/gather_photons.glsl>
};
struct irradiance_estimate {
#include <photongrid/estimate/irradiance_estimate.glsl>
};

#undef float
#include <photongrid/core/end.hpp>

} // namespace photongrid::double_kernels

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace photongrid::testing {

/// The same numbers in double.
inline std::vector<glm::dvec4> widened(const std::vector<glm::vec4>& v) { return {v.begin(), v.end()}; }

/// The scene's records in double, converted from the float records of the float kernels.
struct double_scene {
    std::vector<glm::dvec4> records;
    uint features;
    explicit double_scene(const scene_layout& r) : records(widened(r.records)), features(r.features) {}
};

inline double_kernels::Grid widened(const kernels::Grid& g)
{
    return {glm::dvec4(g.origin), glm::dvec4(g.inverse_cell), glm::dvec4(g.cell), g.resolution};
}

/// Prints the largest and the median of errors; returns the largest.
inline double report_errors(const char* what, std::vector<double> errors)
{
    std::sort(errors.begin(), errors.end());
    std::printf("double oracle: %s: largest %.3g, 99th percentile %.3g, median %.3g of %zu\n", what, errors.back(),
        errors[errors.size() * 99 / 100], errors[errors.size() / 2], errors.size());
    return errors.back();
}

} // namespace photongrid::testing
