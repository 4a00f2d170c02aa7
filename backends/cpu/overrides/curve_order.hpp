// The order of positions along the Hilbert curve of a block map, by radix sorts: of all by the first word, then of
// those with equal words by the next one.
#pragma once

#include <photongrid/backends/cpu/cpu_backend.hpp>
#include <photongrid/backends/cpu/overrides/curve_job.hpp>
#include <photongrid/backends/cpu/overrides/radix_sort.hpp>
#include <photongrid/backends/cpu/overrides/simd.hpp>

#include <algorithm>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::cpu {

/// Pairs (word, position) in an order.
using ordered_pairs = std::span<glm::uvec2>;

inline bool is_before(const glm::uvec2& a, const glm::uvec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

/// Calls f(run) for every run of at least `least` pairs with equal words, but for those that are in no block.
template <class F>
void for_each_run(ordered_pairs pairs, std::size_t least, const F& f)
{
    for (std::size_t first = 0, past = 0; first < pairs.size(); first = past) {
        for (past = first + 1; past < pairs.size() && pairs[past].x == pairs[first].x;)
            ++past;
        if (past - first >= least && pairs[first].x != no_id)
            f(pairs.subspan(first, past - first));
    }
}

/// Orders the runs of equal words in pairs by the words from number `word` on. The words of the pairs are overwritten.
/// Many short runs are ordered at a time, so that their words are found in full registers.
inline void order_runs(const curve_job& j, ordered_pairs pairs, uint word, std::size_t least)
{
    std::vector<ordered_pairs> runs{pairs}, deeper;
    std::vector<glm::uvec2> members;
    for (; word < j.words; ++word) {
        deeper.clear();
        members.clear();
        for (const auto& run : runs)
            for_each_run(run, least, [&](ordered_pairs equal) {
                deeper.push_back(equal);
                members.insert(members.end(), equal.begin(), equal.end());
            });
        if (members.empty())
            return;
        find_words(j, word, members.data(), members.size());
        auto from = members.begin();
        for (const auto& run : deeper) {
            std::copy_n(from, run.size(), run.begin());
            from += static_cast<std::ptrdiff_t>(run.size());
            std::sort(run.begin(), run.end(), is_before);
        }
        std::swap(runs, deeper);
    }
}

/// The pairs of n photons or points for order_along_curve, and what was found of them.
struct begun_order {
    buffer<glm::uvec2> pairs;
    curve_summary seen;
};
inline begun_order begin_order(cpu_backend& device, const curve_job& j, std::size_t n)
{
    begun_order begun{device.make<glm::uvec2>(n), {}};
    const auto pairs = device.elements_to_write(begun.pairs);
    constexpr std::size_t block = 16384;
    std::vector<curve_summary> seen(n / block + 1);
    device.threads().for_blocks(n, block,
        [&](std::size_t first, std::size_t past) { begin_order(j, first, past, pairs.data(), seen[first / block]); });
    for (const auto& s : seen)
        begun.seen |= s;
    return begun;
}

/// Orders pairs by the words from number `word` on: all of them in parallel, then each run of equal words, of which the
/// largest are ordered in parallel themselves. Returns the pairs' place, which is in one of the two buffers.
inline ordered_pairs order_by_words(cpu_backend& device, const curve_job& j, buffer<glm::uvec2>& pairs,
    buffer<glm::uvec2>& scratch, uint word, std::size_t least)
{
    constexpr std::size_t large = 65536, block = 16384;
    auto& threads = device.threads();
    const std::size_t n = pairs.size();
    const auto given = device.elements_to_write(pairs), other = device.elements_to_write(scratch);
    threads.for_blocks(
        n, 4096, [&](std::size_t first, std::size_t past) { find_words(j, word, given.data() + first, past - first); });
    const auto sorted = radix_sort(threads, given.data(), other.data(), n).in_scratch ? other : given;
    if (word + 1 == j.words)
        return sorted;
    for_each_run(sorted, std::max(least, large), [&](ordered_pairs run) {
        auto few = device.make<glm::uvec2>(run.size()), more = device.make<glm::uvec2>(run.size());
        std::copy(run.begin(), run.end(), device.elements_to_write(few).begin());
        const auto ordered = order_by_words(device, j, few, more, word + 1, least);
        for (std::size_t i = 0; i < run.size(); ++i)
            run[i] = {no_id, ordered[i].y}; // done
    });
    // The other runs, many at a time. A run belongs to the block in which it begins.
    std::vector<std::size_t> begin;
    for (std::size_t at = 0; at < n; at += block) {
        std::size_t i = at;
        while (i > 0 && i < n && sorted[i].x == sorted[i - 1].x)
            ++i;
        begin.push_back(i);
    }
    begin.push_back(n);
    threads.for_blocks(begin.size() - 1, 1, [&](std::size_t b, std::size_t) {
        if (begin[b] < begin[b + 1])
            order_runs(j, sorted.subspan(begin[b], begin[b + 1] - begin[b]), word + 1, least);
    });
    return sorted;
}

/// The second number of each pair: the order of positions, from sorted pairs.
inline buffer<uint> values_of(cpu_backend& device, std::span<const glm::uvec2> pairs)
{
    auto ordered = device.make<uint>(pairs.size());
    const auto order = device.elements_to_write(ordered);
    device.threads().for_blocks(pairs.size(), 16384, [&](std::size_t first, std::size_t past) {
        for (std::size_t i = first; i < past; ++i)
            order[i] = pairs[i].y;
    });
    return ordered;
}

/// The order of the positions of a job along its curve. `pairs`: by begin_order(). Runs of fewer than `least` positions
/// with an equal word remain in their order.
inline buffer<uint> order_along_curve(
    cpu_backend& device, const curve_job& j, buffer<glm::uvec2> pairs, std::size_t least)
{
    auto scratch = device.make<glm::uvec2>(pairs.size());
    const auto sorted = order_by_words(device, j, pairs, scratch, 0, least);
    return values_of(device, sorted);
}

} // namespace photongrid::cpu

#include <photongrid/core/exact_end.hpp>
