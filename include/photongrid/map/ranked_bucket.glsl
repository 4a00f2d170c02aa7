// The bucket of photon i: the rank of its virtual cell among the occupied ones, by binary search in the cells of the
// sorted photons, as first_in_cell.glsl does for stored cells (2.2.1).
#include <photongrid/core/none.glsl>
#include <photongrid/map/grid.glsl>
#include <photongrid/map/virtual_cell.glsl>

struct Params {
    Grid grid;
    uint held;  // number of sorted photons
    uint parts; // other_part | caustic_part (map_buffers.hpp)
};
PARAMS(Params)
INPUT(0, vec4, positions)
INPUT(1, vec4, powers)
INPUT(2, uvec2, cells) // of the sorted photons
INPUT(3, uint, sums)   // cells that begin up to there
OUTPUT(0, uint, bucket) // NONE for a photon that no map holds

void kernel(uint i)
{
    vec4 p = positions(i);
    bucket = NONE;
    if (args.held == 0u || !is_held(p, powers(i), args.parts))
        return;
    uvec2 mine = virtual_cell(cell_coordinates(args.grid, p));
    uint low = 0u; // the first photon of the cell is from here ...
    uint high = args.held - 1u; // ... to here
    while (low < high) {
        uint middle = low + (high - low) / 2u;
        uvec2 cell = cells(middle);
        if (cell.y < mine.y || (cell.y == mine.y && cell.x < mine.x))
            low = middle + 1u;
        else
            high = middle;
    }
    bucket = sums(low) - 1u;
}
