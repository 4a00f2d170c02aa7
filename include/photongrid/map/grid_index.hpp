// The index of each cell's first photon (section 2.2.1, figure 4): binary search in the sorted keys, all cells in one
// pass.
#pragma once

#include <photongrid/core/backend.hpp>
#include <photongrid/map/first_in_cell.kernel.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// For every key from 0 to cells - 1: x, the index of its first pair, and y, the number of its pairs. A key without
/// pairs begins where the next key does. `pairs` must be sorted by key; larger keys (invalid photons) are in no cell.
/// One pass with O(log n) reads per cell (section 2.2.1, figure 4).
/// \throws backend_error if the device has no room.
/// \snippet snippets.cpp grid_index
template <backend B>
buffer_of<B, glm::uvec2> grid_index(B& device, const buffer_of<B, glm::uvec2>& pairs, uint cells)
{
    auto index = device.template make<glm::uvec2>(cells);
    device.template run<kernels::first_in_cell>(
        cells, {.pairs = static_cast<uint>(pairs.size())}, reads(pairs), writes(index));
    return index;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
