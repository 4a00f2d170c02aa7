// True for the pixels where a round searches the photon map.
#include <photongrid/render/pixel_tile.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uint, rounds) // pixel_tile.glsl

bool holds(uint i)
{
    return rounds(i) == SEARCHED;
}
