// The cpu backend's override of bitonic_sort: a radix sort.
#pragma once

#include <photongrid/backends/cpu/cpu_backend.hpp>
#include <photongrid/backends/cpu/overrides/radix_sort.hpp>
#include <photongrid/map/bitonic_sort.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Sorts pairs in the same order as the generic bitonic_sort. `steps` is that of the network, `passes` that of the
/// radix sort.
#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    sort_report
    bitonic_sort(cpu_backend& device, cpu_backend::buffer<glm::uvec2>& pairs)
{
    const std::size_t n = pairs.size();
    sort_report report;
    if (n < 2)
        return report;
    const auto levels = static_cast<uint>(std::countr_zero(std::bit_ceil(n)));
    report.steps = levels * (levels + 1) / 2;
    const cpu_backend::stopwatch watch;
    auto scratch = device.make<glm::uvec2>(n);
    const auto sorted = cpu::radix_sort(
        device.threads(), device.elements_to_write(pairs).data(), device.elements_to_write(scratch).data(), n);
    if (sorted.in_scratch)
        std::swap(pairs, scratch);
    report.passes = sorted.passes;
    device.count_passes("radix_sort", report.passes, watch);
    return report;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
