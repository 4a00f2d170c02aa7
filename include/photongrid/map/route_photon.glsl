// The destination of draw i in stencil routing (2.2.2, figure 5). Photons are drawn in a seeded random order: a cell
// keeps those that arrive first, so the order of ids would discard later lights and bounces.
#include <photongrid/map/grid.glsl>
#include <photongrid/core/none.glsl>
#include <photongrid/core/random.glsl>

struct Params {
    Grid grid;
    uint photons;
    uint seed;
    uint parts; // other_part | caustic_part (map_buffers.hpp)
};
PARAMS(Params)
INPUT(0, vec4, positions)
INPUT(1, vec4, powers)
OUTPUT(0, uint, destination)
OUTPUT(1, uint, payload)
OUTPUT(2, vec4, power) // rgb, W; w: 1, which counts the photons

void kernel(uint i)
{
    uint photon = permuted(i, args.photons, args.seed);
    vec4 p = positions(photon);
    vec4 carried = powers(photon);
    destination = NONE;
    payload = photon;
    power = vec4(carried.x, carried.y, carried.z, 1.0f);
    if (!is_held(p, carried, args.parts))
        return;
    uvec4 c = cell_coordinates(args.grid, p);
    destination = cell_number(args.grid, c.x, c.y, c.z);
}
