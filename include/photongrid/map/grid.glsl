// The uniform grid (2.2). Building and searching find a point's cell by the same functions, so they agree bit for bit.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

struct Grid {
    vec4 origin;       // lowest corner, m
    vec4 inverse_cell; // cells per m along each axis
    vec4 cell;         // edges of a cell, m
    uvec4 resolution;  // cells along each axis; w: all cells
};

// Distance from the grid's lowest corner, in cells. It is monotone in x, since the roundings are.
inline float in_cells(float x, float origin, float inverse_cell)
{
    precise float u = (x - origin) * inverse_cell;
    return u;
}

// The cell that holds u. Points outside the grid belong to the border cells, NaN to the first.
inline uint clamped_cell(float u, uint resolution)
{
    float last = float(resolution - 1u);
    float f = floor(u);
    f = f > 0.0f ? f : 0.0f;
    f = f < last ? f : last;
    return min(uint(f), resolution - 1u); // above 2^24 cells `last` may be rounded up
}

inline uvec4 cell_coordinates(Grid grid, vec4 p)
{
    return uvec4(clamped_cell(in_cells(p.x, grid.origin.x, grid.inverse_cell.x), grid.resolution.x),
        clamped_cell(in_cells(p.y, grid.origin.y, grid.inverse_cell.y), grid.resolution.y),
        clamped_cell(in_cells(p.z, grid.origin.z, grid.inverse_cell.z), grid.resolution.z), 0u);
}

// x fastest: a row of cells along x is one contiguous range.
inline uint cell_number(Grid grid, uint x, uint y, uint z)
{
    return (z * grid.resolution.y + y) * grid.resolution.x + x;
}

// A lower bound, m, on the distance along one axis between a query point at u in cell c and the photons of `cell` and
// the cells behind it. The margin covers the rounding of u and of the photons' coordinates (docs/design/decisions.md).
inline float gap(float u, uint c, uint cell, float size)
{
    float margin = (float(cell) + abs(u) + 2.0f) * 9.5367431640625e-7f;
    float g = 0.0f;
    if (cell > c)
        g = float(cell) - u - margin;
    if (cell < c)
        g = u - float(cell + 1u) - margin;
    return g > 0.0f ? g * size : 0.0f;
}

// False for NaN and infinity. It tests the exponent's bits, because compilers may turn !(x <= largest) into x >
// largest, which is false for NaN (Mesa does).
inline bool is_finite(vec4 p)
{
    return (floatBitsToUint(p.x) & 0x7F800000u) != 0x7F800000u && (floatBitsToUint(p.y) & 0x7F800000u) != 0x7F800000u
        && (floatBitsToUint(p.z) & 0x7F800000u) != 0x7F800000u;
}

// Whether a photon belongs to one of the given parts of the light. Caustic photons have a position with w = 1
// (light_part).
inline bool is_of_parts(vec4 position, uint parts)
{
    return (parts & (position.w == 1.0f ? 2u : 1u)) != 0u;
}

// Whether a map of the given parts of the light holds a photon: it must be finite.
inline bool is_held(vec4 position, vec4 power, uint parts)
{
    return is_finite(position) && is_finite(power) && is_of_parts(position, parts);
}

#endif
