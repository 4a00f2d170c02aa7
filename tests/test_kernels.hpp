// The kernels of tests/kernels, which show single functions of the tracer to tests; their texts are
// `test_kernel_texts`.
#pragma once

#include <photongrid/test_kernel_text.hpp>
#include <photongrid/trace_kernels.hpp>

#include <photongrid/kernels/begin.hpp>
namespace photongrid::kernels {
struct ray_probe {
#include "kernels/ray_probe.glsl"
};
struct shaft_probe {
#include "kernels/shaft_probe.glsl"
};
struct glass_probe {
#include "kernels/glass_probe.glsl"
};
struct angle_probe {
#include "kernels/angle_probe.glsl"
};
struct random_probe {
#include "kernels/random_probe.glsl"
};
struct basis_probe {
#include "kernels/basis_probe.glsl"
};
} // namespace photongrid::kernels
#include <photongrid/kernels/end.hpp>
