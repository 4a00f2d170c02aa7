// The cpu backend's override of grid_index: one scan of the sorted pairs.
#pragma once

#include <photongrid/backends/cpu/cpu_backend.hpp>
#include <photongrid/map/grid_index.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The same result as the generic grid_index.
#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    cpu_backend::buffer<glm::uvec2>
    grid_index(cpu_backend& device, const cpu_backend::buffer<glm::uvec2>& pairs, uint cells)
{
    const cpu_backend::stopwatch watch;
    auto index = device.make<glm::uvec2>(cells);
    const auto from = device.elements(pairs);
    const auto to = device.elements_to_write(index);
    const std::size_t n = from.size();
    // If pair i has another key than the pair before, all cells after that pair's key, up to the key of pair i, begin
    // at i.
    const auto cell_after = [&](std::size_t i) {
        return i == 0 ? 0u : i > n ? cells : std::min(cells, from[i - 1].x == 0xFFFFFFFFu ? cells : from[i - 1].x + 1u);
    };
    device.threads().for_blocks(n + 1, 65536, [&](std::size_t first, std::size_t past) {
        for (std::size_t i = first; i < past; ++i) {
            const uint begin = cell_after(i), end = i == n ? cells : cell_after(i + 1);
            for (uint c = begin; c < end; ++c)
                to[c].x = static_cast<uint>(i);
        }
    });
    const auto in_cells = static_cast<uint>(
        std::lower_bound(from.begin(), from.end(), cells, [](const glm::uvec2& p, uint key) { return p.x < key; })
        - from.begin());
    device.threads().for_blocks(cells, 65536, [&](std::size_t first, std::size_t past) {
        for (std::size_t c = first; c < past; ++c)
            to[c].y = (c + 1 < cells ? to[c + 1].x : in_cells) - to[c].x;
    });
    device.count_passes("grid_index", 1, watch);
    return index;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
