// Cells of a virtual grid: at most 2^21 along an axis, so that a cell has a number of 63 bits.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

// The number of the cell with coordinates c, x fastest: x + 2^21 y + 2^42 z. x: its low 32 bits; y: its high 31 bits.
inline uvec2 virtual_cell(uvec4 c)
{
    return uvec2(c.x | (c.y << 21u), (c.y >> 11u) | (c.z << 10u));
}

#endif
