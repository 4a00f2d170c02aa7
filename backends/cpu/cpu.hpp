// The cpu backend: kernels on as many threads as the caller wants, with sorting, building maps and searching by SIMD
// and other algorithms. Slow to compile, since it is compiled for several instruction sets: include it in one file of a
// program, or link photongrid::cpu_compiled.
#pragma once

#include <photongrid/backends/cpu/cpu_backend.hpp>
#if !defined(PHOTONGRID_CPU_COMPILED) // else the library has them
#include <photongrid/backends/cpu/overrides/bitonic_sort.hpp>
#include <photongrid/backends/cpu/overrides/grid_index.hpp>
#include <photongrid/backends/cpu/overrides/knn_grid_estimate.hpp>
#include <photongrid/backends/cpu/overrides/knn_neighbours.hpp>
#include <photongrid/backends/cpu/overrides/sorted_map.hpp>
#endif
