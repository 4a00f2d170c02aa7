// Radix sort of pairs: stable, with as many digits as the differing bits need. The least significant digit is sorted
// first, except if there are too many pairs for a cache.
#pragma once

#include <photongrid/backends/cpu/buffer.hpp>
#include <photongrid/backends/cpu/overrides/simd.hpp>
#include <photongrid/backends/cpu/pool.hpp>

#include <array>
#include <bit>
#include <utility>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::cpu {

/// The result of a sort.
struct radix_report {
    uint passes = 0;
    bool in_scratch = false; ///< the sorted pairs are in the second range
};

/// The number of pairs of which two copies fit a core's cache.
inline constexpr std::size_t in_cache = 65536;

/// The number of digits of at most 11 bits: 2,048 counters fit the first-level cache.
constexpr uint digits_for(uint bits) { return (bits + 10) / 11; }

/// Counts how often a digit has each value in pairs first to past - 1. The digit is passed by value, so that the
/// compiler can assume that stores do not change it.
inline void count_digits(digit by, const glm::uvec2* from, std::size_t first, std::size_t past, uint* counts)
{
    if (by.of_value)
        for (std::size_t i = first; i < past; ++i)
            ++counts[from[i].y >> by.shift & by.mask];
    else
        for (std::size_t i = first; i < past; ++i)
            ++counts[from[i].x >> by.shift & by.mask];
}

/// Moves n pairs in the order of a digit, one at a time.
inline void scatter_in_cache(digit by, const glm::uvec2* from, glm::uvec2* to, std::size_t n)
{
    for (std::size_t i = 0; i < n; i += pairs_per_line)
        __builtin_prefetch(to + i, 1);
    std::array<uint, digit::most> next; // the first mask + 1 of them
    std::fill_n(next.begin(), by.mask + 1, 0u);
    count_digits(by, from, 0, n, next.data());
    uint sum = 0;
    for (uint value = 0; value <= by.mask; ++value)
        sum += std::exchange(next[value], sum);
    for (std::size_t i = 0; i < n; ++i)
        to[next[by.of(from[i])]++] = from[i];
}

using counters = std::vector<std::array<uint, digit::most>>; ///< of each range

/// scatter_in_cache() for any number of pairs, in parallel: each task moves a range of `part` pairs. `next` has the
/// counts of each digit per range, and is overwritten. Returns the index of each digit's first pair, and n.
inline std::vector<uint> scatter_counted(
    pool& threads, const digit& by, std::span<const glm::uvec2> from, glm::uvec2* to, std::size_t part, counters& next)
{
    const std::size_t n = from.size();
    std::vector<uint> begin(std::size_t{by.mask} + 2);
    uint sum = 0;
    for (uint value = 0; value <= by.mask; ++value) {
        begin[value] = sum;
        for (auto& of_part : next)
            sum += std::exchange(of_part[value], sum);
    }
    begin.back() = sum;
    if (n <= in_cache) {
        threads.for_blocks(n, part, [&](std::size_t first, std::size_t past) {
            auto& mine = next[first / part];
            for (std::size_t i = first; i < past; ++i)
                to[mine[by.of(from[i])]++] = from[i];
        });
        return begin;
    }
    constexpr std::size_t line_pairs = digit::most * pairs_per_line;
    storage line_memory(next.size() * line_pairs * sizeof(glm::uvec2));
    auto* const lines = reinterpret_cast<glm::uvec2*>(line_memory.begin());
    threads.for_blocks(n, part, [&](std::size_t first, std::size_t past) {
        const std::size_t p = first / part;
        scatter_pairs(by, from.subspan(first, past - first), next[p].data(), to, lines + p * line_pairs);
    });
    return begin;
}

/// Which bits differ in a range of pairs, and whether the values ascend, as ids do. If the values ascend, a stable sort
/// by key suffices.
struct key_summary {
    glm::uvec2 any{0u}, all{~0u};
    uint descents = 0;

    glm::uvec2 varying() const { return any ^ all; }
    key_summary& operator|=(const key_summary& other)
    {
        any |= other.any;
        all &= other.all;
        descents |= other.descents;
        return *this;
    }
};
inline key_summary summarise(const glm::uvec2* pairs, std::size_t first, std::size_t past)
{
    uint any_x = 0, all_x = ~0u, any_y = 0, all_y = ~0u; // scalars, which compilers vectorise
    for (std::size_t i = first; i < past; ++i) {
        any_x |= pairs[i].x;
        all_x &= pairs[i].x;
        any_y |= pairs[i].y;
        all_y &= pairs[i].y;
    }
    uint descents = 0;
    for (std::size_t i = std::max<std::size_t>(first, 1); i < past; ++i)
        descents |= pairs[i - 1].y > pairs[i].y ? 1u : 0u;
    return {{any_x, any_y}, {all_x, all_y}, descents};
}
/// The same for a sample of the pairs.
inline key_summary sample(const glm::uvec2* pairs, std::size_t n)
{
    key_summary l;
    for (std::size_t i = 0; i < n; i += n / 256 + 1)
        l |= summarise(pairs, i, i + 1);
    return l;
}

/// A range of `bits` bits from bit `low` on.
struct bit_range {
    uint low = 0, bits = 0;
    explicit bit_range(uint varying)
        : low(varying != 0 ? static_cast<uint>(std::countr_zero(varying)) : 0),
          bits(32 - static_cast<uint>(std::countl_zero(varying)) - low)
    {
    }
};

/// The most significant digit of keys, by which many pairs are partitioned, so that the rest of the work fits a cache.
inline digit first_digit(const bit_range& r)
{
    const uint width = std::min(r.bits, std::clamp(r.bits, 19u, 21u) - 11u);
    return {false, r.low + r.bits - width, (1u << width) - 1};
}

/// Sorts n pairs by (x, y). Both ranges have room for n pairs and begin on cache lines. The report says which one has
/// the result.
inline radix_report radix_sort(pool& threads, glm::uvec2* pairs, glm::uvec2* scratch, std::size_t n)
{
    radix_report report;
    if (n < 2)
        return report;
    // One range per thread, so that counters are not shared. The result does not depend on the number of ranges.
    const std::size_t parts = n < 16384 ? 1 : threads.threads(), part = (n + parts - 1) / parts;
    counters counts((n + part - 1) / part);
    std::vector<key_summary> seen(counts.size());

    // The pass over all pairs that summarises them also counts the digit that a sample suggests as the first.
    const digit probable = first_digit(bit_range(sample(pairs, n).varying().x));
    constexpr std::size_t block = 2048; // so small that it stays in the cache for the second loop
    threads.for_blocks(n, part, [&](std::size_t first, std::size_t past) {
        auto& mine = counts[first / part];
        mine.fill(0);
        for (std::size_t b = first; b < past; b += block) {
            const std::size_t end = std::min(past, b + block);
            seen[first / part] |= summarise(pairs, b, end);
            if (n > in_cache)
                count_digits(probable, pairs, b, end, mine.data());
        }
    });
    key_summary whole;
    for (const auto& l : seen)
        whole |= l;

    glm::uvec2 *from = pairs, *to = scratch;
    const auto count = [&](const digit& by) {
        threads.for_blocks(n, part, [&](std::size_t first, std::size_t past) {
            auto& mine = counts[first / part];
            mine.fill(0);
            count_digits(by, from, first, past, mine.data());
        });
    };
    const auto least_digit_first = [&](bool values, const bit_range& r) {
        const uint digits = digits_for(r.bits), width = (r.bits + digits - 1) / std::max(digits, 1u);
        for (uint d = 0; d < digits; ++d) {
            const digit by{values, r.low + d * width, (1u << width) - 1};
            count(by);
            scatter_counted(threads, by, {from, n}, to, part, counts);
            std::swap(from, to);
        }
        report.passes += digits;
    };
    const bit_range keys(whole.varying().x);
    if (whole.descents != 0)
        least_digit_first(true, bit_range(whole.varying().y));
    if (n <= in_cache || digits_for(keys.bits) < 2) {
        least_digit_first(false, keys);
    } else {
        const digit by = first_digit(keys);
        if (!(by == probable) || whole.descents != 0)
            count(by);
        const auto begin = scatter_counted(threads, by, {from, n}, to, part, counts);
        const uint rest = by.shift - keys.low, digits = digits_for(rest), width = (rest + digits - 1) / digits;
        threads.for_blocks(begin.size() - 1, 8, [&](std::size_t first, std::size_t past) {
            for (std::size_t bucket = first; bucket < past; ++bucket) {
                glm::uvec2 *here = to + begin[bucket], *there = from + begin[bucket];
                for (uint d = 0; d < digits; ++d) {
                    scatter_in_cache({false, keys.low + d * width, (1u << width) - 1}, here, there,
                        begin[bucket + 1] - begin[bucket]);
                    std::swap(here, there);
                }
            }
        });
        if (digits % 2 == 0)
            std::swap(from, to);
        report.passes += 1 + digits;
    }
    report.in_scratch = from != pairs;
    return report;
}

} // namespace photongrid::cpu

#include <photongrid/core/exact_end.hpp>
