// The functions and constants that kernels share, read as C++ once, at namespace scope. Within a kernel's struct their
// files are then empty (kernels/begin.hpp).
#pragma once

#include <glm/glm.hpp>
#include <glm/integer.hpp>
#include <photongrid/kernel.hpp>

#define precise
namespace photongrid::kernels {

using namespace glm; // kernels are GLSL: its names are GLM's

#include <photongrid/kernels/distance_key.glsl>
#include <photongrid/kernels/grid.glsl>
#include <photongrid/kernels/natural_log.glsl>
#include <photongrid/kernels/photon_event.glsl>
#include <photongrid/kernels/random.glsl>
#include <photongrid/kernels/scene_layout.glsl>
#include <photongrid/kernels/vector.glsl>

} // namespace photongrid::kernels
#undef precise
