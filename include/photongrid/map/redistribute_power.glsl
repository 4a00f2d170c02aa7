// The power of photon i after its cell's surplus has been redistributed (2.2.2). This includes photons that were not
// kept, which no search finds.
#include <photongrid/map/grid.glsl>
#include <photongrid/map/redistributed.glsl>

struct Params {
    Grid grid;
};
PARAMS(Params)
INPUT(0, vec4, positions)
INPUT(1, vec4, powers)
INPUT(2, vec4, scales)
INPUT(3, vec4, surpluses)
OUTPUT(0, vec4, power)

void kernel(uint i)
{
    uvec4 c = cell_coordinates(args.grid, positions(i));
    uint cell = cell_number(args.grid, c.x, c.y, c.z);
    power = redistributed(powers(i), scales(cell), surpluses(cell));
}
