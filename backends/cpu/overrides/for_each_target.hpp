// All SIMD code, for simd.hpp: Highway reads one file once for every instruction set, so no include guard.
#include <photongrid/backends/cpu/overrides/map_simd.hpp>
#include <photongrid/backends/cpu/overrides/scatter_simd.hpp>
#include <photongrid/backends/cpu/overrides/search_simd.hpp>
