// Functions that kernels share, read as C++: what a kernel of yours gets by #include "grid.glsl", "distance_key.glsl",
// "random.glsl" or "vector.glsl" is then there already.
#pragma once

#include <photongrid/kernels/begin.hpp>

namespace photongrid::kernels {

using namespace glm; // kernels are GLSL: its names are GLM's

#include <photongrid/kernels/distance_key.glsl>
#include <photongrid/kernels/grid.glsl>
#include <photongrid/kernels/random.glsl>
#include <photongrid/kernels/vector.glsl>

} // namespace photongrid::kernels

#include <photongrid/kernels/end.hpp>
