// The estimates after a round: those of before, found by its search, or interpolated. An interpolated estimate has the
// least radius of those that it comes from: an interpolated one might be rounded differently on different devices, and
// later rounds decide by it.
#include <photongrid/render/pixel_tile.glsl>

struct Params {
    uvec2 size; // of the picture, pixels
};
PARAMS(Params)
INPUT(0, uint, rounds)      // pixel_tile.glsl
INPUT(1, uint, searched)    // searched_words.glsl
INPUT(2, uint, sums)        // inclusive prefix sums of their bits
INPUT(3, vec4, founds)      // of the search; w: squared radius, m^2
INPUT(4, uvec2, counts)     // photons used, photons visited
INPUT(5, vec4, befores)     // of the pixels, before the round
INPUT(6, uvec2, counted)
OUTPUT(0, vec4, irradiance) // rgb, W/m^2; w: squared radius, m^2; 0 without an estimate
OUTPUT(1, uvec2, used)

#include <photongrid/render/search_number.glsl>

void kernel(uint i)
{
    vec4 e = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    uvec2 n = uvec2(0u, 0u);
    uint round = rounds(i);
    if (round == KEPT) {
        e = befores(i);
        n = counted(i);
    } else if (round == SEARCHED) {
        e = founds(search_number(i));
        n = counts(search_number(i));
    } else if (round >= IN_TILE) {
        PixelTile t = tile_of(i, args.size, round - IN_TILE);
        float photons = 0.0f;
        float radius2 = 3.0e38f;
        for (uint c = 0u; c < 4u; ++c) {
            uint corner = corner_of(t, c);
            vec4 there = befores(corner);
            float weight = corner_weight(t, c);
            e += there * weight;
            photons += float(counted(corner).x) * weight;
            radius2 = min(radius2, there.w);
        }
        e = vec4(e.x, e.y, e.z, radius2);
        n = uvec2(uint(photons + 0.5f), 0u);
    }
    irradiance = e;
    used = n;
}
