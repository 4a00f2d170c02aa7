// The kernels of the four algorithms: every kernel file, read as C++, once.
#pragma once

#include <photongrid/kernels/begin.hpp>

namespace photongrid::kernels {

using namespace glm; // kernels are GLSL: its names are GLM's

#include <photongrid/kernels/grid.glsl>
#include <photongrid/kernels/random.glsl>

struct arithmetic_probe {
#include <photongrid/kernels/arithmetic_probe.glsl>
};

// 2.2.1
struct photon_cell {
#include <photongrid/kernels/photon_cell.glsl>
};
struct bitonic_step {
#include <photongrid/kernels/bitonic_step.glsl>
};
struct pad_pairs {
#include <photongrid/kernels/pad_pairs.glsl>
};
struct pair_value {
#include <photongrid/kernels/pair_value.glsl>
};
struct first_in_cell {
#include <photongrid/kernels/first_in_cell.glsl>
};
struct invalid_photon {
#include <photongrid/kernels/invalid_photon.glsl>
};

// 2.2.2
struct route_photon {
#include <photongrid/kernels/route_photon.glsl>
};
struct routed_cell {
#include <photongrid/kernels/routed_cell.glsl>
};
struct redistribute_power {
#include <photongrid/kernels/redistribute_power.glsl>
};
struct overfull_cell {
#include <photongrid/kernels/overfull_cell.glsl>
};

// 2.3
struct knn_start {
#include <photongrid/kernels/knn_start.glsl>
};
struct knn_visit {
#include <photongrid/kernels/knn_visit.glsl>
};
struct knn_result {
#include <photongrid/kernels/knn_result.glsl>
};

} // namespace photongrid::kernels

#include <photongrid/kernels/end.hpp>
