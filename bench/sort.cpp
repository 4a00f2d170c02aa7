// Sorting pairs of a 32-bit key and a 32-bit value against std::sort, Highway's vqsort and TBB's parallel_sort, all on
// the same pairs, compared whole: docs/reference/measures.md. Prints PASS or FAIL per row; exits 1 where one is too
// slow, 3 where the order differs.
#include "stopwatch.hpp"
#include "verbs.hpp"

#include <photongrid/backends/cpu/overrides/bitonic_sort.hpp>

#include <hwy/contrib/sort/vqsort.h>
#include <tbb/global_control.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstdio>
#include <random>

namespace {

using namespace photongrid;
using bench::median;
using bench::ms_of;
using pair_bits = std::uint64_t; ///< the key above the value, so that comparing numbers compares pairs

std::vector<pair_bits> make_pairs(std::size_t n, std::uint32_t keys)
{
    std::mt19937 engine(1);
    std::vector<pair_bits> pairs;
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t key
            = keys == 0 ? static_cast<std::uint32_t>(engine()) : static_cast<std::uint32_t>(engine()) % keys;
        pairs.push_back(pair_bits{key} << 32 | i);
    }
    return pairs;
}

int run_sort(unsigned threads, std::size_t most)
{
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    cpu_backend b(threads);
    hwy::Sorter vqsort;
    int worst = 0;
    std::printf("%u thread%s; ms, medians of seven\n\n| pairs | keys | photongrid | std::sort | vqsort, 1 thread | TBB "
                "parallel_sort | over std::sort | wanted | |\n|---|---|---|---|---|---|---|---|---|\n",
        threads, threads == 1 ? "" : "s");
    for (const std::size_t n : {std::size_t{65536}, std::size_t{1} << 20, std::size_t{1} << 24})
        for (const std::uint32_t keys : {31250u, 1000000u, 0u}) {
            if (n > most)
                continue;
            const auto pairs = make_pairs(n, keys);
            std::vector<glm::uvec2> host, result;
            for (const auto& p : pairs)
                host.emplace_back(static_cast<uint>(p >> 32), static_cast<uint>(p));
            std::vector<pair_bits> expected, sorted;
            std::vector<double> by_std, by_vqsort, by_tbb, ours;
            bool right = true;
            for (int i = 0; i < 7; ++i) { // in turn, so that a slow minute of the machine is everybody's
                expected = pairs;
                by_std.push_back(ms_of([&] { std::sort(expected.begin(), expected.end()); }));
                sorted = pairs;
                by_vqsort.push_back(ms_of([&] { vqsort(sorted.data(), n, hwy::SortAscending()); }));
                right = right && sorted == expected;
                sorted = pairs;
                by_tbb.push_back(ms_of([&] { tbb::parallel_sort(sorted.begin(), sorted.end()); }));
                auto buffer = b.upload(std::span<const glm::uvec2>(host));
                ours.push_back(ms_of([&] { bitonic_sort(b, buffer); }));
                result = b.download(buffer);
            }
            for (std::size_t i = 0; i < n; ++i)
                right = right && (pair_bits{result[i].x} << 32 | result[i].y) == expected[i];
            const bool counts = n == std::size_t{1} << 20 && keys == 1000000u
                && threads == 1; // what the map of a million photons needs
            const double ratio = median(by_std) / median(ours);
            const bool good = right && (!counts || ratio >= 8);
            worst = std::max(worst, !right ? 3 : good ? 0 : 1);
            std::printf("| %zu | %s | %.2f | %.2f | %.2f | %.2f | %.1f | %s | %s |\n", n,
                keys == 0 ? "32 bits" : std::to_string(keys).c_str(), median(ours), median(by_std), median(by_vqsort),
                median(by_tbb), ratio, counts ? "8" : "",
                !right        ? "WRONG"
                    : !counts ? ""
                    : good    ? "PASS"
                              : "FAIL");
            std::fflush(stdout);
        }
    return worst;
}

} // namespace

photongrid::bench::verb_run photongrid::bench::add_sort(CLI::App& verb)
{
    const auto threads = std::make_shared<unsigned>(1);
    const auto most = std::make_shared<std::size_t>(1 << 24);
    verb.add_option("--threads", *threads)->check(CLI::PositiveNumber);
    verb.add_option("--most", *most, "sorts no more pairs than that");
    return [=] { return run_sort(*threads, *most); };
}
