// Decides what a round of interpolated_estimates.hpp does for each pixel: interpolate its estimate among the corners of
// its tile if all are near, on the same surface, and have estimates; search the photon map if the pixel is a corner of
// the round's own tiles; or leave it to the next round.
#include <photongrid/core/vector.glsl>
#include <photongrid/render/pixel_tile.glsl>

struct Params {
    uvec2 size;     // of the picture, pixels
    uint number;    // of the round, 0 to 2; 3: the only one, which interpolates nothing
    float spacing2; // largest squared distance of a corner, in its estimate's squared radius
};
PARAMS(Params)
INPUT(0, vec4, points)      // xyz, m; w > 0: an estimate is wanted
INPUT(1, vec4, surfaces)    // xyz: unit normal
INPUT(2, uint, befores)     // what the round before did; rounds 0 and 3 read none of them
INPUT(3, vec4, irradiances) // w: squared radius of the estimates so far, m^2
OUTPUT(0, uint, round)      // pixel_tile.glsl

float distance2(uint a, uint b)
{
    precise vec3 way = vec3(points(b)) - vec3(points(a));
    return dot3(way, way);
}

// The shape of the tiles in which round 2 interpolates.
uint small_shape(uint i)
{
    PixelTile t = tile_of(i, args.size, LARGE);
    precise float across = float(t.last.y - t.first.y);
    precise float down = float(t.last.x - t.first.x);
    precise float across2 = distance2(corner_of(t, 0u), corner_of(t, 1u)) * across * across;
    precise float down2 = distance2(corner_of(t, 0u), corner_of(t, 2u)) * down * down;
    return down2 > 4.0f * across2 ? ROW : across2 > 4.0f * down2 ? COLUMN : SMALL;
}

bool is_near(uint i, uint corner)
{
    if (befores(corner) == NO_ESTIMATE)
        return false;
    vec3 n = vec3(surfaces(i));
    precise vec3 way = vec3(points(corner)) - vec3(points(i));
    precise float height = dot3(n, way);
    precise float away2 = dot3(way, way);
    precise float largest2 = args.spacing2 * irradiances(corner).w;
    precise float flat2 = 0.01f * away2; // up to 5.7 degrees from the surface at the pixel
    // Normals up to 8 degrees apart.
    return away2 <= largest2 && height * height <= flat2 && dot3(n, vec3(surfaces(corner))) >= 0.99f;
}

bool is_between_corners(uint i, uint shape)
{
    PixelTile t = tile_of(i, args.size, shape);
    for (uint c = 0u; c < 4u; ++c)
        if (!is_near(i, corner_of(t, c)))
            return false;
    return true;
}

void kernel(uint i)
{
    bool is_later = args.number == 1u || args.number == 2u;
    round = NO_ESTIMATE;
    if (is_later && befores(i) != NO_ESTIMATE) {
        round = KEPT;
        return;
    }
    if (!(points(i).w > 0.0f))
        return;
    uint shape = args.number == 2u ? small_shape(i) : LARGE; // to interpolate in
    if (is_later && is_between_corners(i, shape))
        round = IN_TILE + shape;
    else if (args.number >= 2u || is_corner(tile_of(i, args.size, args.number == 1u ? small_shape(i) : LARGE)))
        round = SEARCHED;
}
