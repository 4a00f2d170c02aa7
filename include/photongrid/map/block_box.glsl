// Half of the box around a block of photons: element i is the lowest or the highest corner of a box on the lowest level
// of the tree (block_tree.glsl). Photons that are not finite or not of the parts of the light are left out, so the
// kernel also finds the box of photons that are not sorted yet.
#include <photongrid/map/block_tree.glsl>
#include <photongrid/map/grid.glsl>

struct Params {
    uint first;   // the level's first node
    uint photons; // how many there are
    uint parts;   // other_part | caustic_part (map_buffers.hpp)
};
PARAMS(Params)
INPUT(0, vec4, positions)
INPUT(1, vec4, powers)
OUTPUT(0, vec4, corner)

void kernel(uint i)
{
    bool is_high = i % (2u * BLOCK) >= BLOCK;
    uint node = i / (2u * BLOCK) * BLOCK + i % BLOCK;
    uint first = (node - args.first) * BLOCK;
    uint held = first < args.photons ? min(args.photons - first, BLOCK) : 0u;
    vec4 farthest = is_high ? high_of_nothing() : low_of_nothing();
    for (uint photon = first; photon < first + held; ++photon) {
        vec4 p = positions(photon);
        if (is_held(p, powers(photon), args.parts))
            farthest = is_high ? higher_corner(farthest, p) : lower_corner(farthest, p);
    }
    corner = farthest;
}
