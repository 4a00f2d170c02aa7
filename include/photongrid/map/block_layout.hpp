// What the number of photons and their box say about a block map: the size of its tree and its curve. block_map.hpp
// builds by it, and map_file_format.hpp checks files by it.
#pragma once

#include <photongrid/map/block_tree.kernel.hpp>
#include <photongrid/map/hilbert.kernel.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

inline constexpr uint most_words = 9; // of the curve: 90 binary digits per axis, as far as floats near 0 differ

/// The number of blocks, or nodes, that hold so many photons, or nodes of the level below.
inline uint block_count(uint held) { return held / kernels::BLOCK + (held % kernels::BLOCK != 0 ? 1u : 0u); }

/// The number of levels of a tree over `photons` photons: at least 1.
inline uint tree_levels(uint photons)
{
    uint levels = 1;
    for (auto held = std::uint64_t{16} * kernels::BLOCK; held < photons; held *= 16)
        ++levels;
    return levels;
}
/// The number of nodes of that tree, unused ones included.
inline uint tree_nodes(uint photons)
{
    const uint blocks = std::max(block_count(photons), 1u);
    return kernels::first_of_level(tree_levels(photons) - 1) + kernels::BLOCK * block_count(blocks);
}

/// The curve through the box of all photons, m. Without photons it is any curve.
inline kernels::Curve curve_through(const glm::vec4& low, const glm::vec4& high)
{
    // No search finds photons at distances above 10^19 m, so those far outside need no order.
    const glm::vec4 limit(1e19f);
    kernels::Curve c{glm::clamp(low, -limit, limit), glm::clamp(high, -limit, limit), glm::vec4(0)};
    float farthest = 1e-14f; // the scale of the last word must fit a float
    for (int axis = 0; axis < 3; ++axis) {
        const float nearest = std::min(std::max(0.0f, c.low[axis]), c.high[axis]);
        farthest = std::max({farthest, nearest - c.low[axis], c.high[axis] - nearest});
    }
    c.scale.x = std::ldexp(1.0f, -std::ilogb(farthest) - 2); // farthest < 2^(ilogb + 1)
    c.scale.y = 0.5f / c.scale.x;
    return c;
}

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
