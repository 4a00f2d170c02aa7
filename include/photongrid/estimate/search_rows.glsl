// Finds the photons of a row of cells that can lie within a radius. Included by kernels after their `cells` input.

// The lowest and the highest cell along one axis that can hold photons within `radius` of x. The function is the one by
// which the photons were put into cells, and it is monotone. The caller has enlarged the radius by the rounding error.
uvec2 cells_within(float x, float radius, float origin, float inverse_cell, uint resolution)
{
    precise float low = x - radius;
    precise float high = x + radius;
    return uvec2(clamped_cell(in_cells(low, origin, inverse_cell), resolution),
        clamped_cell(in_cells(high, origin, inverse_cell), resolution));
}

// The square root of radius2, rounded up far enough that no photon at a squared distance of radius2 or less lies beyond
// it. 2^-20 covers a few roundings of 2^-24 each: of the squared distance, of this product, and of square roots on
// devices that do not round them correctly. The constant covers squared distances that are so small that they count as
// 0.
float wider(float radius2)
{
    precise float r = sqrt(radius2) * 1.00000095f + 1.1e-19f;
    return r;
}

// The first and one past the last photon of row (y, z) that can lie within radius2 of p; an empty range if none can.
uvec2 photons_of_row(vec4 p, uint y, uint z, uvec4 c, float radius2)
{
    float gap_y = gap(in_cells(p.y, args.grid.origin.y, args.grid.inverse_cell.y), c.y, y, args.grid.cell.y);
    float gap_z = gap(in_cells(p.z, args.grid.origin.z, args.grid.inverse_cell.z), c.z, z, args.grid.cell.z);
    precise float left2 = radius2 - (gap_y * gap_y + gap_z * gap_z) + radius2 * 9.5367432e-7f;
    if (!(left2 >= 0.0f))
        return uvec2(0u, 0u);
    uvec2 x = cells_within(p.x, wider(left2), args.grid.origin.x, args.grid.inverse_cell.x, args.grid.resolution.x);
    uint row = cell_number(args.grid, 0u, y, z);
    uvec2 last = cells(row + x.y);
    return uvec2(cells(row + x.x).x, last.x + last.y);
}
