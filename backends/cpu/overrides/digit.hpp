// A digit of a pair's key or value, as radix_sort.hpp takes one after the other.
#pragma once

#include <photongrid/backend/kernel.hpp>

#include <algorithm>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid::cpu {

/// Some bits of a pair's key (x) or value (y).
struct digit {
    static constexpr std::size_t most = 2048; ///< values that a digit can have
    bool of_value = false;
    uint shift = 0, mask = 0;

    bool operator==(const digit&) const = default;
    uint of(const glm::uvec2& pair) const { return (of_value ? pair.y : pair.x) >> shift & mask; }
};

inline constexpr std::size_t pairs_per_line = 8; ///< of 8 bytes, in a cache line of 64

} // namespace photongrid::cpu

#include <photongrid/backend/exact_end.hpp>
