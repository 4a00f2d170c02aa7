// photongrid::cpu_compiled: what cpu.hpp defines in headers, compiled once.
#include <photongrid/backends/cpu/cpu_backend.hpp>
#include <photongrid/backends/cpu/overrides/bitonic_sort.hpp>
#include <photongrid/backends/cpu/overrides/grid_index.hpp>
#include <photongrid/backends/cpu/overrides/knn_grid_estimate.hpp>
#include <photongrid/backends/cpu/overrides/knn_neighbours.hpp>
#include <photongrid/backends/cpu/overrides/sorted_map.hpp>
