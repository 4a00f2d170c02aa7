// The kernels of the four algorithms: every kernel file, read as C++, once.
#pragma once

#include <photongrid/kernels/begin.hpp>

namespace photongrid::kernels {

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
struct take_vector {
#include <photongrid/kernels/take_vector.glsl>
};
struct other_part {
#include <photongrid/kernels/other_part.glsl>
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
struct prefix_sum_step {
#include <photongrid/kernels/prefix_sum_step.glsl>
};
struct packed_cell {
#include <photongrid/kernels/packed_cell.glsl>
};
struct packed_photon {
#include <photongrid/kernels/packed_photon.glsl>
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
struct kth_guess {
#include <photongrid/kernels/kth_guess.glsl>
};
struct kth_distance {
#include <photongrid/kernels/kth_distance.glsl>
};
struct kth_result {
#include <photongrid/kernels/kth_result.glsl>
};
struct kth_tie {
#include <photongrid/kernels/kth_tie.glsl>
};
struct given_radius {
#include <photongrid/kernels/given_radius.glsl>
};
struct grown_radius {
#include <photongrid/kernels/grown_radius.glsl>
};
struct gather_start {
#include <photongrid/kernels/gather_start.glsl>
};
struct gather_photons {
#include <photongrid/kernels/gather_photons.glsl>
};
struct neighbours_start {
#include <photongrid/kernels/neighbours_start.glsl>
};
struct list_neighbours {
#include <photongrid/kernels/list_neighbours.glsl>
};
struct neighbour_pair {
#include <photongrid/kernels/neighbour_pair.glsl>
};
struct sort_neighbours {
#include <photongrid/kernels/sort_neighbours.glsl>
};
struct neighbour {
#include <photongrid/kernels/neighbour.glsl>
};
struct no_estimate {
#include <photongrid/kernels/no_estimate.glsl>
};
struct irradiance_estimate {
#include <photongrid/kernels/irradiance_estimate.glsl>
};

} // namespace photongrid::kernels

#include <photongrid/kernels/end.hpp>
