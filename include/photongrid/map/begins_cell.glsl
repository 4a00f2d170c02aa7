// The virtual cell of the i-th photon in order of cells, and whether it is the first photon of that cell. The sum of
// the latter up to a photon is the rank of its cell among the occupied ones, plus 1.
#include <photongrid/map/grid.glsl>
#include <photongrid/map/virtual_cell.glsl>

struct Params {
    Grid grid;
};
PARAMS(Params)
INPUT(0, vec4, positions)
INPUT(1, uint, order)
OUTPUT(0, uvec2, cell)
OUTPUT(1, uint, begins) // 1 or 0

void kernel(uint i)
{
    cell = virtual_cell(cell_coordinates(args.grid, positions(order(i))));
    begins = 1u;
    if (i > 0u) {
        uvec2 before = virtual_cell(cell_coordinates(args.grid, positions(order(i - 1u))));
        begins = before.x == cell.x && before.y == cell.y ? 0u : 1u;
    }
}
