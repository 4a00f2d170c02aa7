// photongrid::cpu_compiled: the definitions of cpu.hpp, compiled once.
#include <photongrid/backends/cpu/cpu_backend.hpp>
#include <photongrid/backends/cpu/overrides/bitonic_sort.hpp>
#include <photongrid/backends/cpu/overrides/block_map.hpp>
#include <photongrid/backends/cpu/overrides/grid_index.hpp>
#include <photongrid/backends/cpu/overrides/knn_grid_estimate.hpp>
#include <photongrid/backends/cpu/overrides/knn_neighbours.hpp>
#include <photongrid/backends/cpu/overrides/ray_search.hpp>
#include <photongrid/backends/cpu/overrides/sorted_map.hpp>
