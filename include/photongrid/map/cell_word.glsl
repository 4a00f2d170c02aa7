// The pair of a photon for sorting by one word of its virtual cell's number: (word, place in the order so far), as
// curve_key.glsl does for the curve. The low word comes first, in the order of ids, then the high word. Photons that no
// map holds get the largest high word, which no cell has.
#include <photongrid/core/none.glsl>
#include <photongrid/map/grid.glsl>
#include <photongrid/map/virtual_cell.glsl>

struct Params {
    Grid grid;
    uint photons; // how many there are; further pairs are padding
    uint parts;   // other_part | caustic_part (map_buffers.hpp)
};
PARAMS(Params)
SWITCH(0, HIGH_WORD) // and the photons are in an order already
INPUT(0, vec4, positions)
INPUT(1, vec4, powers)
INPUT(2, uint, order)
OUTPUT(0, uvec2, pair)

void kernel(uint i)
{
    pair = uvec2(NONE, NONE);
    if (i >= args.photons)
        return;
    pair.y = i;
    uint photon = i;
    if (HIGH_WORD)
        photon = order(i);
    vec4 p = positions(photon);
    if (!is_held(p, powers(photon), args.parts))
        return;
    uvec2 cell = virtual_cell(cell_coordinates(args.grid, p));
    pair.x = HIGH_WORD ? cell.y : cell.x;
}
