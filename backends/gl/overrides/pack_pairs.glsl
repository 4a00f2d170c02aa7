// Packs two pairs into a texel, in the order after the network's first step, and pads with the largest possible pair. A
// user's pair that equals the padding has the same bits, so no pair can be lost.
#include "two_pairs.glsl"

struct Params {
    uint pairs; // number of pairs
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
