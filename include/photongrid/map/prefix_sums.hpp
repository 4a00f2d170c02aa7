// Prefix sums (Hillis and Steele 1986, with four terms per step instead of two) by gather passes.
#pragma once

#include <photongrid/core/backend.hpp>
#include <photongrid/map/prefix_sum_step.kernel.hpp>

#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Inclusive prefix sums: element i of the result is the sum of terms 0 to i, modulo 2^32. ceil(log4 n) passes, at
/// least one.
/// \throws backend_error if the device has no room for two more buffers of n elements.
/// \snippet snippets.cpp prefix_sums
template <backend B>
buffer_of<B, uint> prefix_sums(B& device, const buffer_of<B, uint>& terms)
{
    const auto n = terms.size();
    auto sums = device.template make<uint>(n);
    auto next = device.template make<uint>(n);
    device.template run<kernels::prefix_sum_step>(n, {.stride = 1u}, reads(terms), writes(sums));
    for (std::size_t stride = 4; stride < n; stride *= 4) {
        device.template run<kernels::prefix_sum_step>(
            n, {.stride = static_cast<uint>(stride)}, reads(sums), writes(next));
        std::swap(sums, next);
    }
    return sums;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
