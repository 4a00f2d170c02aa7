// A photon map in buffers. It is of one of two kinds, which all searches read:
//
// A grid map has photons stored cell by cell, the grid, and the index of each cell's first photon. Sorting (2.2.1) and
// stencil routing (2.2.2) both produce it. Cells are stored without gaps, x fastest, so the photons of a row of
// neighbouring cells are contiguous.
//
// A block map has photons along a curve, 16 to a block, and boxes around the blocks (block_map.hpp).
#pragma once

#include <photongrid/core/backend.hpp>
#include <photongrid/map/grid.kernel.hpp>
#include <photongrid/map/hilbert.kernel.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Photons in buffers of backend B: one element per photon in each buffer.
template <backend B>
struct photons {
    buffer_of<B, glm::vec4> positions;    ///< xyz, m; w: 1 for caustic photons, else 0
    buffer_of<B, glm::vec4> powers;       ///< rgb, W; w: in a routed map, how often the photon is in it
    buffer_of<B, glm::vec4> directions{}; ///< xyz: unit vector; empty unless needed
    buffer_of<B, glm::vec4> normals{};    ///< xyz: geometric, unit, of the surfaces; empty unless needed

    /// The number of photons.
    uint size() const { return static_cast<uint>(positions.size()); }
};

// The parts of the light that a map can be made of, as bits; other_part | caustic_part is every_part.
inline constexpr uint other_part = 1u;   ///< photons whose position has a w other than 1
inline constexpr uint caustic_part = 2u; ///< photons whose position has w = 1: caustic photons
inline constexpr uint every_part = 3u;   ///< both

/// A uniform grid: origin, cell edges (m) and resolution, as kernels read it.
using grid = kernels::Grid;

namespace detail {
    /// Fits the cells of `g` along each axis to the box from `low` to `high`. `caller` names itself in errors.
    inline void fit_axes(grid& g, const char* caller, glm::vec3 low, glm::vec3 high, glm::uvec3 resolution)
    {
        const float scale = std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x),
            std::abs(high.y), std::abs(high.z), high.x - low.x, high.y - low.y, high.z - low.z});
        for (int axis = 0; axis < 3; ++axis) {
            if (!std::isfinite(low[axis]) || !std::isfinite(high[axis]) || !std::isfinite(high[axis] - low[axis])
                || high[axis] < low[axis])
                throw std::invalid_argument(std::string(caller) + ": low, high: axis " + std::to_string(axis)
                    + " goes from " + std::to_string(low[axis]) + " to " + std::to_string(high[axis])
                    + "; both must be finite, and low not larger than high");
            const float extent = std::max({high[axis] - low[axis], 1e-6f * scale, 1e-30f});
            g.origin[axis] = low[axis];
            g.cell[axis] = extent / static_cast<float>(resolution[axis]);
            g.inverse_cell[axis] = static_cast<float>(resolution[axis]) / extent;
        }
    }
} // namespace detail

/// A grid of `resolution` cells over the box from `low` to `high` (m). An axis without extent gets a small one, so that
/// photons in a plane need no special case. Points outside belong to the border cells.
/// \throws std::invalid_argument for a resolution of 0, more than 2^31 cells, or a box that is not finite.
/// \snippet snippets.cpp make_grid
inline grid make_grid(glm::vec3 low, glm::vec3 high, glm::uvec3 resolution)
{
    const auto cells = std::uint64_t{resolution.x} * resolution.y * resolution.z;
    if (resolution.x < 1 || resolution.y < 1 || resolution.z < 1
        || std::uint64_t{resolution.x} * resolution.y > (1u << 31) || cells > (1u << 31))
        throw std::invalid_argument("make_grid: resolution: " + std::to_string(resolution.x) + " x "
            + std::to_string(resolution.y) + " x " + std::to_string(resolution.z)
            + " cells; each axis needs at least 1, all together at most 2^31");
    grid g{};
    g.resolution = glm::uvec4(resolution, static_cast<uint>(cells));
    detail::fit_axes(g, "make_grid", low, high, resolution);
    return g;
}

/// The number of cells of `g`.
inline uint cell_count(const grid& g) { return g.resolution.w; }

/// A photon map. In a grid map the photons of cell c are the cells[c].y elements from cells[c].x on, in every buffer of
/// `photons` and in `list`. In a block map, block b has the elements from 16 b on, up to in_blocks. The photons that
/// are in no cell or block come last.
template <backend B>
struct map_buffers {
    grid cells_of{};                ///< grid map: the grid of the cells
    photongrid::photons<B> photons; ///< cell by cell, or block by block
    buffer_of<B, glm::uvec2> cells; ///< grid map: x: first, y: count. Empty in a block map
    buffer_of<B, glm::vec4> boxes;  ///< block map: the tree's boxes (block_tree.glsl). Empty in a grid map
    uint levels = 0;                ///< block map: of the tree
    uint in_blocks = 0;             ///< block map: photons in blocks
    kernels::Curve curve{};         ///< block map: the curve through the blocks
    uint words = 0;                 ///< block map: words of the curve that photons are sorted by
    /// Ids: indices into the photons that the map was made from; `no_id`: none. In a routed map an id may occur
    /// several times (surplus_kind::photons).
    buffer_of<B, uint> list;
    uint invalid = 0;           ///< photons in no cell or block: NaN or infinite
    uint left_out = 0;          ///< photons in no cell or block: of another part of the light
    uint overflowing_cells = 0; ///< routed: cells that received more photons than they have slots
    buffer_of<B, glm::vec4>
        surpluses; ///< routed: per cell, w: power of photons not kept, W, given to those kept; empty if sorted

    /// Whether an id may occur several times in `list`: in routed maps.
    bool may_repeat() const { return surpluses.size() > 0; }
    /// Whether this is a block map; else a grid map.
    bool has_blocks() const { return boxes.size() > 0; }
    /// The edges, m, of the box of the photons in a block map, or of the grid.
    glm::vec3 extent() const
    {
        return has_blocks() ? glm::max(glm::vec3(curve.high) - glm::vec3(curve.low), 0.0f)
                            : glm::vec3(cells_of.cell) * glm::vec3(cells_of.resolution);
    }
};

namespace detail {
    /// The sum of the fourth components, which it reads back.
    template <backend B>
    double sum_of_w(B& device, const buffer_of<B, glm::vec4>& vectors)
    {
        double sum = 0;
        for (const auto& v : device.download(vectors))
            sum += static_cast<double>(v.w);
        return sum;
    }
} // namespace detail

/// The power, W, all channels together, that stencil routing moved from photons that it could not keep to the others of
/// their cells (2.2.2); 0 for a sorted map. Reads the surpluses back.
/// \throws backend_error if the device fails.
/// \snippet snippets.cpp redistributed_power
template <backend B>
double redistributed_power(B& device, const map_buffers<B>& map)
{
    return detail::sum_of_w(device, map.surpluses);
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
