// What else an estimate has, such as its standard error, after a round: see take_estimate.glsl.
#include <photongrid/render/pixel_tile.glsl>

struct Params {
    uvec2 size; // of the picture, pixels
};
PARAMS(Params)
INPUT(0, uint, rounds)   // pixel_tile.glsl
INPUT(1, uint, searched) // searched_words.glsl
INPUT(2, uint, sums)     // inclusive prefix sums of their bits
INPUT(3, vec4, founds)   // of the search
INPUT(4, vec4, befores)
OUTPUT(0, vec4, value)

#include <photongrid/render/search_number.glsl>

void kernel(uint i)
{
    vec4 v = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    uint round = rounds(i);
    if (round == KEPT) {
        v = befores(i);
    } else if (round == SEARCHED) {
        v = founds(search_number(i));
    } else if (round >= IN_TILE) {
        PixelTile t = tile_of(i, args.size, round - IN_TILE);
        for (uint c = 0u; c < 4u; ++c)
            v += befores(corner_of(t, c)) * corner_weight(t, c);
    }
    value = v;
}
