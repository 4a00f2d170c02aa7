// Two pairs to a texel, each two in the order that the network's first step leaves them in; filled up with the largest pair
// there is. A pair of the user's that equals the filling is the same bits, so none can be lost.
#include "two_pairs.glsl"

struct Params {
    uint pairs; // how many there are
};
PARAMS(Params)
INPUT(0, uvec2, pairs)
OUTPUT(0, uvec4, texel)

void kernel(uint i)
{
    texel = uvec4(0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu);
    if (2u * i + 1u < args.pairs)
        texel = uvec4(pairs(2u * i).x, pairs(2u * i).y, pairs(2u * i + 1u).x, pairs(2u * i + 1u).y);
    else if (2u * i < args.pairs)
        texel = uvec4(pairs(2u * i).x, pairs(2u * i).y, 0xFFFFFFFFu, 0xFFFFFFFFu);
    texel = in_order(texel, (i & 1u) == 0u);
}
