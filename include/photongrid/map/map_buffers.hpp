// What a photon map is: photons cell by cell, a uniform grid over them, and where each cell's photons begin. Sorting
// (2.2.1) and stencil routing (2.2.2) both end in this form, so one estimate serves both. Cells follow each other
// without gaps, x fastest, so the photons of a row of neighbouring cells are one range.
#pragma once

#include <photongrid/backend/backend.hpp>
#include <photongrid/map/grid.kernel.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// Photons in buffers of backend B, one element each, all of the same length.
template <backend B>
struct photons {
    buffer_of<B, glm::vec4> positions;    ///< xyz, m; w: 1 for caustic photons, else 0
    buffer_of<B, glm::vec4> powers;       ///< rgb flux, W
    buffer_of<B, glm::vec4> directions{}; ///< xyz: unit vector of travel; empty where nobody asks for it
    buffer_of<B, glm::vec4> normals{}; ///< xyz: unit normal of the surface they are on; empty where nobody asks for it

    /// Photons.
    uint size() const { return static_cast<uint>(positions.size()); }
};

// Parts of the light that a map may be made of, as bits.
inline constexpr uint other_part = 1u;   ///< photons with 0 in the w of their position
inline constexpr uint caustic_part = 2u; ///< photons with 1 there: the tracer's caustic photons
inline constexpr uint every_part = 3u;   ///< both

/// A uniform grid: origin, cell edges (m) and resolution, as kernels read it.
using grid = kernels::Grid;

/// A grid of `resolution` cells over the box from `low` to `high` (m). An axis without extent gets a thin one, so that
/// planar photons need no special care. Points outside belong to the border cells.
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
    const float scale = std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x), std::abs(high.y),
        std::abs(high.z), high.x - low.x, high.y - low.y, high.z - low.z});
    for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(low[axis]) || !std::isfinite(high[axis]) || !std::isfinite(high[axis] - low[axis])
            || high[axis] < low[axis])
            throw std::invalid_argument("make_grid: low, high: axis " + std::to_string(axis) + " goes from "
                + std::to_string(low[axis]) + " to " + std::to_string(high[axis])
                + "; both must be finite and the first not larger");
        const float extent = std::max({high[axis] - low[axis], 1e-6f * scale, 1e-30f});
        g.origin[axis] = low[axis];
        g.cell[axis] = extent / static_cast<float>(resolution[axis]);
        g.inverse_cell[axis] = static_cast<float>(resolution[axis]) / extent;
    }
    return g;
}

/// How many cells `g` has.
inline uint cell_count(const grid& g) { return g.resolution.w; }

/// A photon map: see the top of this file. Cell c's photons are elements cells[c].x and the next cells[c].y of every
/// buffer of `photons` and of `list`; past the last cell's stand those that are in no cell.
template <backend B>
struct map_buffers {
    grid cells_of{};                ///< the grid that the cells are of
    photongrid::photons<B> photons; ///< cell by cell
    buffer_of<B, glm::uvec2> cells; ///< x: first, y: count
    buffer_of<B, uint> list;    ///< ids: which of the photons that the map was made from stands here; 0xFFFFFFFF: none
    uint invalid = 0;           ///< photons in no cell: NaN or infinite
    uint left_out = 0;          ///< photons in no cell: of a part of the light that was not wanted
    uint overflowing_cells = 0; ///< cells for which more photons were destined than they have slots (routed)
    buffer_of<B, glm::vec4>
        surpluses; ///< routed: per cell, w: flux of photons not kept, W, given to the kept; empty when sorted
};

/// Flux (W, all channels together) that stencil routing took from photons it could not keep and gave to the others of
/// their cells; 0 for a sorted map (2.2.2). Reads the surpluses back.
/// \throws backend_error when the device fails.
/// \snippet snippets.cpp redistributed_power
template <backend B>
double redistributed_power(B& b, const map_buffers<B>& map)
{
    double sum = 0;
    for (const auto& s : b.download(map.surpluses))
        sum += static_cast<double>(s.w);
    return sum;
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
