// The Hilbert curve in three dimensions, level by level: each level cuts a cube into 8 and visits them in an order that
// depends on the cube's orientation (Hamilton, Compact Hilbert Indices, 2006). Neighbours on the curve are neighbours
// in space, so that runs of photons along it fit small boxes.
//
// A position's digits along the curve have no last level: they come in words of 10 levels, 30 bits, of which a map
// takes as many as its densest clusters need.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

// The space that a curve fills. Coordinates are taken relative to the point of the photons' box that is nearest to 0,
// because floats are finest there.
struct Curve {
    vec4 low;   // the photons' box, m
    vec4 high;
    vec4 scale; // x: a power of two; y: 0.5 / x: no photon is farther from the nearest point along an axis
};

// Ten binary digits of each coordinate of q for a word of the curve. `scale`: Curve::scale.x x 2^(10 word). Denormals
// count as 0.
inline uint curve_digits(float q, float scale, uint word)
{
    precise float steps = abs(q) < 1.17549435e-38f ? 0.0f : q * scale;
    precise float rest = steps - floor(steps);
    uint digits = min(uint(rest * 1024.0f), 1023u);
    return word == 0u ? digits ^ 512u : digits; // in two's complement the negative half comes second
}

// The coordinate whose digits are taken: relative to the box's nearest point to 0, and at most `most` from it.
inline float curve_coordinate(float p, float low, float high, float most)
{
    precise float q = p - min(max(0.0f, low), high);
    return min(max(q, -most), most * 0.99999994f);
}

// Per number of an octant along the curve: the corner at which the curve enters it, three bits each, and the axis along
// which it leaves, two bits each.
const uint CURVE_ENTERS = 0x00BB3600u;
const uint CURVE_LEAVES = 0x00001694u;

// Advances by one level. `state`: the orientation of the cube: bits 0 to 2 are its first corner, 3 and 4 its axis.
// `octant`: one bit of each coordinate. Returns x: the octant's number along the curve, 0 to 7; y: the state there.
inline uvec2 curve_level(uint octant, uint state)
{
    uint corner = state & 7u;
    uint axis = state >> 3u;
    uint turn = axis + 1u; // 1 to 3
    uint mixed = octant ^ corner;
    uint gray = ((mixed >> turn) | (mixed << (3u - turn))) & 7u;
    uint number = gray ^ (gray >> 1u) ^ (gray >> 2u);
    uint enters = (CURVE_ENTERS >> (3u * number)) & 7u;
    uint leaves = (CURVE_LEAVES >> (2u * number)) & 3u;
    uint turned = ((enters << turn) | (enters >> (3u - turn))) & 7u;
    uint next_axis = turn + leaves; // 1 to 5
    next_axis = next_axis >= 3u ? next_axis - 3u : next_axis;
    return uvec2(number, (corner ^ turned) | (next_axis << 3u));
}

// One word of the curve: ten levels. `x`, `y`, `z`: curve_digits(). Returns x: 30 bits; y: the state after it.
inline uvec2 curve_word(uint x, uint y, uint z, uint state)
{
    uint word = 0u;
    for (uint level = 0u; level < 10u; ++level) {
        uint shift = 9u - level;
        uvec2 next = curve_level(
            ((x >> shift) & 1u) | (((y >> shift) & 1u) << 1u) | (((z >> shift) & 1u) << 2u), state);
        word = (word << 3u) | next.x;
        state = next.y;
    }
    return uvec2(word, state);
}

// The coordinates of a position on the curve, for words_along.
inline vec4 curve_coordinates(Curve curve, vec4 p)
{
    return vec4(curve_coordinate(p.x, curve.low.x, curve.high.x, curve.scale.y),
        curve_coordinate(p.y, curve.low.y, curve.high.y, curve.scale.y),
        curve_coordinate(p.z, curve.low.z, curve.high.z, curve.scale.y), 0.0f);
}

// Word number `word` of curve_coordinates(). `scale`: Curve::scale.x x 2^(10 word); `state`: after the word before, 0
// for the first. Returns x: 30 bits; y: the state after it.
inline uvec2 word_along(vec4 q, float scale, uint word, uint state)
{
    return curve_word(
        curve_digits(q.x, scale, word), curve_digits(q.y, scale, word), curve_digits(q.z, scale, word), state);
}

#endif
