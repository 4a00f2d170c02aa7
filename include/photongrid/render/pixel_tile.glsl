// Tiles of pixels, among whose corners estimates are interpolated (interpolated_estimates.hpp).
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

// What a round does for a pixel's estimate.
const uint NO_ESTIMATE = 0u; // nothing: the pixel has none, or gets it in a later round
const uint KEPT = 1u;        // nothing: it is there from an earlier round
const uint SEARCHED = 2u;    // takes it from a search in the photon map
const uint IN_TILE = 3u;     // plus the shape: takes it from the corners of the pixel's tile of that shape

// The shapes of tiles.
const uint LARGE = 0u;
const uint SMALL = 1u;
const uint ROW = 2u;    // for surfaces that are farther from row to row than from column to column
const uint COLUMN = 3u; // the opposite

inline uvec2 tile_sides(uint shape) // powers of two
{
    if (shape == SMALL)
        return uvec2(4u, 4u);
    return uvec2(shape == COLUMN ? 1u : 8u, shape == ROW ? 1u : 8u);
}

// A pixel in its tile: columns and rows. Tiles at the right and lower edges of a picture may have fewer pixels.
struct PixelTile {
    uvec2 pixel;
    uvec2 first;
    uvec2 last;
    uint width; // of the picture, pixels
};

// `size`: of the picture, pixels.
inline PixelTile tile_of(uint i, uvec2 size, uint shape)
{
    PixelTile t;
    t.width = size.x;
    t.pixel.y = i / size.x;
    t.pixel.x = i - t.pixel.y * size.x;
    uvec2 sides = tile_sides(shape);
    t.first = uvec2(t.pixel.x & ~(sides.x - 1u), t.pixel.y & ~(sides.y - 1u));
    t.last = uvec2(min(t.first.x + sides.x, size.x) - 1u, min(t.first.y + sides.y, size.y) - 1u);
    return t;
}

inline bool is_corner(PixelTile t)
{
    return (t.pixel.x == t.first.x || t.pixel.x == t.last.x) && (t.pixel.y == t.first.y || t.pixel.y == t.last.y);
}

// The pixel at corner 0 to 3: upper left, upper right, lower left, lower right.
inline uint corner_of(PixelTile t, uint corner)
{
    uint x = (corner & 1u) == 0u ? t.first.x : t.last.x;
    uint y = (corner & 2u) == 0u ? t.first.y : t.last.y;
    return y * t.width + x;
}

// Its weight in the bilinear interpolation at the pixel. The four add up to 1.
inline float corner_weight(PixelTile t, uint corner)
{
    float x = t.last.x > t.first.x ? float(t.pixel.x - t.first.x) / float(t.last.x - t.first.x) : 0.0f;
    float y = t.last.y > t.first.y ? float(t.pixel.y - t.first.y) / float(t.last.y - t.first.y) : 0.0f;
    return ((corner & 1u) == 0u ? 1.0f - x : x) * ((corner & 2u) == 0u ? 1.0f - y : y);
}
#endif
