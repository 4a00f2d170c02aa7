// A map that suits the photons, so that the caller need not choose one: a fitted grid where they spread evenly, else
// blocks.
#pragma once

#include <photongrid/map/block_map.hpp>
#include <photongrid/map/fitting_grid.hpp>
#include <photongrid/map/grid_maps.hpp>

#include <algorithm>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace detail {
    /// How many others of `photons` photons, of which `sample` is a part, share a photon's cell of grid g, on average
    /// over the photons.
    inline double crowding(const std::vector<glm::vec3>& sample, const grid& g, uint photons)
    {
        std::vector<uint> cells;
        for (const auto& p : sample) {
            const glm::uvec4 c = kernels::cell_coordinates(g, glm::vec4(p, 0));
            cells.push_back(kernels::cell_number(g, c.x, c.y, c.z));
        }
        std::sort(cells.begin(), cells.end());
        double pairs = 0; // of sample photons that share a cell
        for (std::size_t first = 0, past = 0; first < cells.size(); first = past) {
            for (past = first; past < cells.size() && cells[past] == cells[first];)
                ++past;
            const auto held = static_cast<double>(past - first);
            pairs += held * (held - 1);
        }
        const auto size = static_cast<double>(std::max<std::size_t>(sample.size(), 2));
        return static_cast<double>(photons) * pairs / (size * (size - 1));
    }
} // namespace detail

/// Builds the map in which searches for the k nearest are expected to be fastest: a sorted map in a fitted grid
/// (fitting_grid), or a block map. It is a block map where the photons lie in clusters, so that more than 200 + 4 k of
/// them share a photon's cell of that grid; and where k is 1 on devices whose capabilities say `prefers_blocks`
/// (decisions.md, "A grid or blocks"). Reads back a sample of 16,384 positions. `parts`: as in sorted_map.
/// \throws backend_error if the device has no room.
/// \snippet snippets.cpp fitted_map
template <backend B>
map_buffers<B> fitted_map(B& device, photons<B> p, uint k, uint parts = every_part)
{
    if (k == 1 && device.caps().prefers_blocks)
        return block_map(device, std::move(p), parts);
    const auto sample = detail::sample_positions(device, p, detail::grid_sample);
    const grid g = detail::grid_fitting(sample, p.size(), k, device.caps().cells_per_radius);
    if (detail::crowding(sample, g, p.size()) > 200 + 4 * static_cast<double>(k))
        return block_map(device, std::move(p), parts);
    return sorted_map(device, std::move(p), g, parts);
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
