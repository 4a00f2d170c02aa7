// Half of the box around 16 boxes: element i is the lowest or the highest corner of a box above the lowest level of the
// tree (block_tree.glsl).
#include <photongrid/map/block_tree.glsl>

struct Params {
    uint nodes; // of the whole tree
};
PARAMS(Params)
INPUT(0, vec4, corners)
OUTPUT(0, vec4, corner) // of the same tree, of a higher level than those read

void kernel(uint i)
{
    bool is_high = i % (2u * BLOCK) >= BLOCK;
    uint child = first_child(i / (2u * BLOCK) * BLOCK + i % BLOCK);
    vec4 farthest = is_high ? high_of_nothing() : low_of_nothing();
    if (child < args.nodes) // its siblings too: they are stored together
        for (uint n = 0u; n < BLOCK; ++n)
            farthest = is_high ? higher_corner(farthest, corners(high_corner(child + n)))
                               : lower_corner(farthest, corners(low_corner(child + n)));
    corner = farthest;
}
