// The bucket of photon i: a hash of its virtual cell (section 4.4). Cells may share a bucket.
#include <photongrid/core/none.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/map/grid.glsl>

struct Params {
    Grid grid;
    uint buckets;
    uint parts; // other_part | caustic_part (map_buffers.hpp)
};
PARAMS(Params)
INPUT(0, vec4, positions)
INPUT(1, vec4, powers)
OUTPUT(0, uint, bucket) // NONE for a photon that no map holds

void kernel(uint i)
{
    vec4 p = positions(i);
    bucket = NONE;
    if (!is_held(p, powers(i), args.parts))
        return;
    uvec4 c = cell_coordinates(args.grid, p);
    bucket = scrambled(scrambled(scrambled(c.x) + c.y) + c.z) % args.buckets;
}
