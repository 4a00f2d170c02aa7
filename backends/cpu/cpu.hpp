// The cpu backend: runs kernels on any number of threads, and sorts, builds maps and searches by its own SIMD code. It
// is compiled for several instruction sets (overrides/simd.hpp) and therefore slowly: include it in one file, or link
// photongrid::cpu_compiled.
#pragma once

#include <photongrid/backends/cpu/cpu_backend.hpp>
#if !defined(PHOTONGRID_CPU_COMPILED) // else the library photongrid::cpu_compiled defines the overrides
#include <photongrid/backends/cpu/overrides/bitonic_sort.hpp>
#include <photongrid/backends/cpu/overrides/block_map.hpp>
#include <photongrid/backends/cpu/overrides/grid_index.hpp>
#include <photongrid/backends/cpu/overrides/knn_grid_estimate.hpp>
#include <photongrid/backends/cpu/overrides/knn_neighbours.hpp>
#include <photongrid/backends/cpu/overrides/ray_search.hpp>
#include <photongrid/backends/cpu/overrides/sorted_map.hpp>
#endif
#include <photongrid/backends/cpu/overrides/trace_batch.hpp>
