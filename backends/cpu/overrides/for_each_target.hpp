// All SIMD code, for simd.hpp. Highway includes this file once per instruction set, so it has no include guard.
#include <photongrid/backends/cpu/overrides/lanes_simd.hpp> // the others use it

#include <photongrid/backends/cpu/overrides/curve_simd.hpp>
#include <photongrid/backends/cpu/overrides/map_simd.hpp>
#include <photongrid/backends/cpu/overrides/rays_simd.hpp>
#include <photongrid/backends/cpu/overrides/scatter_simd.hpp>
#include <photongrid/backends/cpu/overrides/search_simd.hpp>
