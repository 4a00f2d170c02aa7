// A grid too fine to store (section 4.4): its cells have coordinates and numbers, but no memory.
#pragma once

#include <photongrid/map/map_buffers.hpp>
#include <photongrid/map/virtual_cell.kernel.hpp>

#include <cstdint>
#include <stdexcept>
#include <string>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A uniform grid of up to 2^21 cells along each axis, none of which is stored. make_virtual_grid makes one.
struct virtual_grid {
    grid axes{}; ///< as kernels read it; its number of all cells is 0, because that takes up to 63 bits
};

namespace detail {
    inline constexpr uint most_virtual_cells = 1u << 21; // along an axis

    /// Throws unless each axis of the grid has from 1 to 2^21 cells.
    inline void check_virtual_cells(const char* caller, glm::uvec3 resolution)
    {
        for (int axis = 0; axis < 3; ++axis)
            if (resolution[axis] < 1 || resolution[axis] > most_virtual_cells)
                throw std::invalid_argument(std::string(caller) + ": resolution: axis " + std::to_string(axis) + " has "
                    + std::to_string(resolution[axis])
                    + " cells; each axis needs from 1 to 2^21 = 2097152 (make_virtual_grid)");
    }
} // namespace detail

/// A grid of `resolution` cells over the box from `low` to `high` (m), as make_grid, but of up to 2^21 cells an axis.
/// Points outside belong to the border cells. Faces are as exact as floats: with 2^21 cells along an axis, within half
/// a cell of where they should be. They are the same on every backend.
/// \throws std::invalid_argument for an axis of 0 or more than 2^21 cells, or a box that is not finite.
/// \snippet snippets.cpp make_virtual_grid
inline virtual_grid make_virtual_grid(glm::vec3 low, glm::vec3 high, glm::uvec3 resolution)
{
    detail::check_virtual_cells("make_virtual_grid", resolution);
    virtual_grid g;
    g.axes.resolution = glm::uvec4(resolution, 0);
    detail::fit_axes(g.axes, "make_virtual_grid", low, high, resolution);
    return g;
}

/// The number of cells of `g`, up to 2^63.
inline std::uint64_t cell_count(const virtual_grid& g)
{
    return std::uint64_t{g.axes.resolution.x} * g.axes.resolution.y * g.axes.resolution.z;
}

/// The number of the cell that holds `position` (m): x + 2^21 y + 2^42 z of its coordinates, below 2^63.
inline std::uint64_t cell_number(const virtual_grid& g, glm::vec3 position)
{
    const glm::uvec2 words = kernels::virtual_cell(kernels::cell_coordinates(g.axes, glm::vec4(position, 0)));
    return std::uint64_t{words.y} << 32 | words.x;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
