// Everything that the cpu backend does faster than by kernels. Include it before the algorithms are used with a
// cpu_backend.
#pragma once

#include <photongrid/backends/cpu/overrides/bitonic_sort.hpp>
#include <photongrid/backends/cpu/overrides/grid_index.hpp>
#include <photongrid/backends/cpu/overrides/knn_grid_estimate.hpp>
#include <photongrid/backends/cpu/overrides/knn_neighbours.hpp>
#include <photongrid/backends/cpu/overrides/sorted_map.hpp>
