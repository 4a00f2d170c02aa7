// The SIMD code of the cpu backend's overrides, compiled for every instruction set that the compiler supports. At run
// time Highway selects the best one that the machine has.
#pragma once

// Highway 1.0.3 disables its newest instruction set for x86 by default, and then fails to compile if the compiler may
// use that set everywhere (-march=sapphirerapids).
#pragma push_macro("HWY_WANT_AVX3_DL")
#if defined(__AVXVNNI__) && defined(__AVX512VPOPCNTDQ__) && !defined(HWY_WANT_AVX3_DL)
#define HWY_WANT_AVX3_DL
#endif
// A program that compiles these headers itself has the baseline, AVX2 and AVX-512: the instruction sets between take
// the compiler a quarter of the time, for processors older than 2013. The library cpu_compiled has SSE4 as well.
#if !defined(PHOTONGRID_CPU_COMPILED) && !defined(HWY_DISABLED_TARGETS) && !defined(__SSSE3__)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4)
#endif
// Highway can process only one file per translation unit.
#if defined(HIGHWAY_HWY_FOREACH_TARGET_H_)
#error                                                                                                                 \
    "photongrid: this file has Highway code before <photongrid/backends/cpu/cpu.hpp>; link photongrid::cpu_compiled, or include cpu.hpp in another file"
#endif
#pragma push_macro("HWY_TARGET_INCLUDE")
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "photongrid/backends/cpu/overrides/for_each_target.hpp"
#include <hwy/foreach_target.h>
// Restores the macros of the user's own SIMD code.
#undef HWY_TARGET_INCLUDE
#pragma pop_macro("HWY_TARGET_INCLUDE")
#undef HWY_WANT_AVX3_DL
#pragma pop_macro("HWY_WANT_AVX3_DL")

#include <photongrid/backends/cpu/overrides/for_each_target.hpp>

namespace photongrid::cpu {

HWY_EXPORT(begin_order);
HWY_EXPORT(find_words);
HWY_EXPORT(find_boxes);
HWY_EXPORT(find_cells);
HWY_EXPORT(scatter_photons);
HWY_EXPORT(order_bucket);
HWY_EXPORT(scatter_pairs);
HWY_EXPORT(search_block);
HWY_EXPORT(trace_block);

/// See curve_simd.hpp.
inline void begin_order(const curve_job& j, std::size_t first, std::size_t past, glm::uvec2* pairs, curve_summary& seen)
{
    HWY_DYNAMIC_DISPATCH(begin_order)(j, first, past, pairs, seen);
}
inline void find_words(const curve_job& j, uint word, glm::uvec2* pairs, std::size_t n)
{
    HWY_DYNAMIC_DISPATCH(find_words)(j, word, pairs, n);
}
inline void find_boxes(soa_vectors<const float> photons, uint in_blocks, std::size_t first, std::size_t past,
    uint first_node, soa_vectors<float> corners)
{
    HWY_DYNAMIC_DISPATCH(find_boxes)(photons, in_blocks, first, past, first_node, corners);
}

/// See map_simd.hpp.
inline void find_cells(
    const map_job& j, std::size_t first, std::size_t past, uint* in_bucket, uint& invalid, uint& left_out)
{
    HWY_DYNAMIC_DISPATCH(find_cells)(j, first, past, in_bucket, invalid, left_out);
}
inline void scatter_photons(const map_job& j, std::size_t first, std::size_t past, uint* next, scatter_lines& lines)
{
    HWY_DYNAMIC_DISPATCH(scatter_photons)(j, first, past, next, lines);
}
inline void order_bucket(const map_job& j, uint bucket, std::size_t begin, std::size_t end, bucket_scratch& s)
{
    HWY_DYNAMIC_DISPATCH(order_bucket)(j, bucket, begin, end, s);
}

/// See scatter_simd.hpp.
inline void scatter_pairs(
    const digit& by, std::span<const glm::uvec2> from, uint* next, glm::uvec2* to, glm::uvec2* lines)
{
    HWY_DYNAMIC_DISPATCH(scatter_pairs)(by, from, next, to, lines);
}

/// See search_simd.hpp.
inline void search_block(const search_job& j, std::size_t begin, std::size_t end)
{
    HWY_DYNAMIC_DISPATCH(search_block)(j, begin, end);
}

/// See rays_simd.hpp.
inline void trace_block(const ray_job& j, std::size_t begin, std::size_t end)
{
    HWY_DYNAMIC_DISPATCH(trace_block)(j, begin, end);
}

} // namespace photongrid::cpu
