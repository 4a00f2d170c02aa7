// The pair of photon i for sorting: (cell, id). Invalid photons, photons of other parts of the light, and padding get
// the largest key (2.1, 2.2.1).
#include <photongrid/map/grid.glsl>

struct Params {
    Grid grid;
    uint photons;
    uint parts; // other_part | caustic_part (map_buffers.hpp)
};
PARAMS(Params)
INPUT(0, vec4, positions)
INPUT(1, vec4, powers)
OUTPUT(0, uvec2, pair)

void kernel(uint i)
{
    pair = uvec2(0xFFFFFFFFu, 0xFFFFFFFFu);
    if (i >= args.photons)
        return;
    pair.y = i;
    vec4 p = positions(i);
    if (!is_held(p, powers(i), args.parts))
        return;
    uvec4 c = cell_coordinates(args.grid, p);
    pair.x = cell_number(args.grid, c.x, c.y, c.z);
}
