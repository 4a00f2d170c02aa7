// The pair of a photon for sorting by one word of the Hilbert curve: (word, place in the order so far). Sorting by the
// last word first, and so on to the first one, sorts by all words, since places keep the order of equal ones. Photons
// that are in no block get the largest key.
#include <photongrid/core/none.glsl>
#include <photongrid/map/grid.glsl>
#include <photongrid/map/hilbert.glsl>

struct Params {
    Curve curve;
    uint word;
    uint photons; // how many there are; further pairs are padding
    uint parts;   // other_part | caustic_part (map_buffers.hpp)
};
PARAMS(Params)
SWITCH(0, ORDERED) // the photons are in an order already; else in that of their ids
INPUT(0, vec4, positions)
INPUT(1, vec4, powers)
INPUT(2, uint, order)
OUTPUT(0, uvec2, pair)

void kernel(uint i)
{
    pair = uvec2(NONE, NONE);
    if (i >= args.photons)
        return;
    uint photon = i;
    if (ORDERED)
        photon = order(i);
    vec4 p = positions(photon);
    pair = uvec2(NONE, i);
    if (!is_held(p, powers(photon), args.parts))
        return; // before its coordinates, which may not be finite, become integers
    vec4 q = curve_coordinates(args.curve, p);
    float scale = args.curve.scale.x;
    uvec2 along = uvec2(0u, 0u);
    for (uint word = 0u; word <= args.word; ++word) {
        along = word_along(q, scale, word, along.y);
        scale = scale * 1024.0f;
    }
    pair.x = along.x;
}
