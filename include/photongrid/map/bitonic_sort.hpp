// Bitonic merge sort (section 2.2.1, figures 2 and 3; Batcher 1968). It is a sorting network: the comparisons do not
// depend on the data, so every step is one gather pass.
#pragma once

#include <photongrid/core/backend.hpp>
#include <photongrid/map/bitonic_step.kernel.hpp>
#include <photongrid/map/pad_pairs.kernel.hpp>

#include <bit>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Counts of a sort.
struct sort_report {
    uint steps = 0;  ///< steps of the network, L(L+1)/2 with L = ceil(log2 n): 136 for 65,536, 210 for 1,048,576
    uint passes = 0; ///< passes for these steps; equal to `steps` unless a backend overrides the sort
};

/// Sorts any number of (key, value) pairs in place, ascending by key and then by value. It needs one more buffer of n
/// pairs; while it runs, both buffers are rounded up to a power of two.
/// \throws backend_error if the device has no room.
/// \snippet snippets.cpp bitonic_sort
template <backend B>
sort_report bitonic_sort(B& device, buffer_of<B, glm::uvec2>& pairs)
{
    const std::size_t n = pairs.size();
    sort_report report;
    if (n < 2)
        return report;
    const std::size_t padded = std::bit_ceil(n);
    auto next = device.template make<glm::uvec2>(padded);
    if (padded != n) {
        auto copy = device.template make<glm::uvec2>(padded);
        device.template run<kernels::pad_pairs>(padded, {.pairs = static_cast<uint>(n)}, reads(pairs), writes(copy));
        std::swap(pairs, copy);
    }
    for (std::size_t run = 2; run <= padded; run *= 2)
        for (std::size_t stride = run / 2; stride > 0; stride /= 2) {
            device.template run<kernels::bitonic_step>(padded,
                {.run = static_cast<uint>(run), .stride = static_cast<uint>(stride)}, reads(pairs), writes(next));
            std::swap(pairs, next);
            ++report.steps;
            ++report.passes;
        }
    if (padded != n) {
        auto trimmed = device.template make<glm::uvec2>(n);
        device.template run<kernels::pad_pairs>(n, {.pairs = static_cast<uint>(n)}, reads(pairs), writes(trimmed));
        std::swap(pairs, trimmed);
    }
    return report;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
