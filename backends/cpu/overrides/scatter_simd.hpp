// SIMD code that moves pairs by a digit, a cache line at a time. Included once per instruction set, so it has no
// include guard; other files include simd.hpp.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <photongrid/backends/cpu/overrides/digit.hpp>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Moves the pairs `from` to `to`, which begins on a cache line: the next pair with digit v goes to
/// to[next[v]]. `lines` has room for pairs_per_line pairs per digit. Lines are collected there and then written past
/// the caches (software write-combining; Satish et al., Fast Sort on CPUs and GPUs, 2010), because scattered writes
/// would fetch each line first.
template <bool BY_VALUE>
HWY_INLINE void scatter(digit by, std::span<const glm::uvec2> from, uint* next, glm::uvec2* to, glm::uvec2* lines)
{
    const hn::CappedTag<uint, 2 * pairs_per_line> d;
    const std::size_t width = hn::Lanes(d);
    uint begin[digit::most]; // this range's first pair per digit; its line may begin with pairs of other ranges
    std::copy(next, next + by.mask + 1, begin);
    for (const glm::uvec2 pair : from) {
        const uint v = (BY_VALUE ? pair.y : pair.x) >> by.shift & by.mask;
        const uint at = next[v]++;
        glm::uvec2* const line = lines + v * pairs_per_line;
        line[at % pairs_per_line] = pair;
        if (at % pairs_per_line == pairs_per_line - 1) {
            const uint line_begin = at + 1 - static_cast<uint>(pairs_per_line);
            if (line_begin >= begin[v]) {
                for (std::size_t lane = 0; lane < 2 * pairs_per_line; lane += width)
                    hn::Stream(hn::Load(d, &line->x + lane), d, &to[line_begin].x + lane);
            } else {
                for (uint p = begin[v]; p <= at; ++p)
                    to[p] = line[p % pairs_per_line];
            }
        }
    }
    for (uint v = 0; v <= by.mask; ++v)
        for (uint p
             = std::max(begin[v], next[v] / static_cast<uint>(pairs_per_line) * static_cast<uint>(pairs_per_line));
             p < next[v]; ++p)
            to[p] = lines[v * pairs_per_line + p % pairs_per_line];
    hwy::FlushStream();
}

inline void scatter_pairs(
    const digit& by, std::span<const glm::uvec2> from, uint* next, glm::uvec2* to, glm::uvec2* lines)
{
    if (by.of_value)
        scatter<true>(by, from, next, to, lines);
    else
        scatter<false>(by, from, next, to, lines);
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
