// For each mask of up to 8 lanes, the permutation by which store_some() compresses a register: first the lanes that are
// set, then the others.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace photongrid::cpu {

template <std::size_t LANES>
inline constexpr auto compress_table = [] {
    std::array<std::array<std::int32_t, LANES>, std::size_t{1} << LANES> table{};
    for (std::size_t mask = 0; mask < table.size(); ++mask) {
        std::size_t to = 0;
        for (const bool set : {true, false})
            for (std::size_t lane = 0; lane < LANES; ++lane)
                if ((mask >> lane & 1) == (set ? 1u : 0u))
                    table[mask][to++] = static_cast<std::int32_t>(lane);
    }
    return table;
}();

} // namespace photongrid::cpu
