// The pixels where a round searches the photon map, 32 per word: bit b of word i is pixel 32 i + b.
#include <photongrid/render/pixel_tile.glsl>

struct Params {
    uint pixels;
};
PARAMS(Params)
INPUT(0, uint, rounds) // pixel_tile.glsl
OUTPUT(0, uint, word)
OUTPUT(1, uint, bits) // that are set

void kernel(uint i)
{
    uint all = 0u;
    for (uint b = 0u; b < 32u; ++b) {
        uint pixel = 32u * i + b;
        if (pixel < args.pixels && rounds(pixel) == SEARCHED)
            all |= 1u << b;
    }
    word = all;
    bits = uint(bitCount(all));
}
