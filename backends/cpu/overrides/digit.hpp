// A digit of a pair's key or value, for radix_sort.hpp.
#pragma once

#include <photongrid/core/kernel.hpp>

#include <algorithm>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::cpu {

/// A range of bits of a pair's key (x) or value (y).
struct digit {
    static constexpr std::size_t most = 2048; ///< the largest number of values of a digit
    bool of_value = false;
    uint shift = 0, mask = 0;

    bool operator==(const digit&) const = default;
    uint of(const glm::uvec2& pair) const { return (of_value ? pair.y : pair.x) >> shift & mask; }
};

inline constexpr std::size_t pairs_per_line = 8; ///< pairs of 8 bytes per cache line of 64

} // namespace photongrid::cpu

#include <photongrid/core/exact_end.hpp>
