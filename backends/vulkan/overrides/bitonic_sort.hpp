// The Vulkan backend's bitonic sort: up to four steps of the network per pass, in registers and in place.
#pragma once

#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/map/bitonic_sort.hpp>
#include <photongrid/map/pad_pairs.kernel.hpp>

namespace photongrid {

/// Sorts pairs in the same order as the generic bitonic_sort, in 57 passes instead of 210 for 1,048,576 pairs. It needs
/// no extra memory if n is a power of two, otherwise two more buffers of n pairs. `steps_per_pass`: at most so many, 1
/// to 4.
inline sort_report bitonic_sort(
    vulkan_backend& device, vulkan_backend::buffer<glm::uvec2>& pairs, uint steps_per_pass = 4)
{
    if (steps_per_pass < 1 || steps_per_pass > 4)
        throw std::invalid_argument(
            "bitonic_sort: steps_per_pass: " + std::to_string(steps_per_pass) + "; it must be from 1 to 4");
    const std::size_t n = pairs.size();
    sort_report report;
    if (n < 2)
        return report;
    const std::size_t padded = std::bit_ceil(n);
    if (padded != n) {
        auto copy = device.make<glm::uvec2>(padded);
        device.run<kernels::pad_pairs>(padded, {.pairs = static_cast<uint>(n)}, reads(pairs), writes(copy));
        std::swap(pairs, copy);
    }
    const auto levels = static_cast<uint>(std::countr_zero(padded));
    report.steps = levels * (levels + 1) / 2;
    const auto pass = [&](uint run_bits, uint first_bit, uint steps, bool whole_blocks) {
        device.own_pass("bitonic_strides",
            "#define STEPS " + std::to_string(steps) + "\n#define SORT_BLOCKS " + (whole_blocks ? "1" : "0") + "\n",
            padded >> steps, {static_cast<uint>(padded), 1u << run_bits, 1u << (first_bit + 1 - steps)}, pairs);
        ++report.passes;
    };
    uint run_bits = 1; // log2 of the length of the runs being merged
    if (levels >= steps_per_pass) {
        pass(steps_per_pass, steps_per_pass - 1, steps_per_pass, true);
        run_bits = steps_per_pass + 1;
    }
    for (; run_bits <= levels; ++run_bits)
        for (uint left = run_bits; left > 0;) {
            // Distribute the steps evenly over the passes.
            const uint passes = (left + steps_per_pass - 1) / steps_per_pass, steps = (left + passes - 1) / passes;
            pass(run_bits, left - 1, steps, false);
            left -= steps;
        }
    if (padded != n) {
        auto trimmed = device.make<glm::uvec2>(n);
        device.run<kernels::pad_pairs>(n, {.pairs = static_cast<uint>(n)}, reads(pairs), writes(trimmed));
        std::swap(pairs, trimmed);
    }
    return report;
}

} // namespace photongrid
