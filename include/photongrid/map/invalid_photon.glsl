// True for a photon with a NaN or infinite position or power. Such photons are in no cell; they are counted.
#include <photongrid/map/grid.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, positions)
INPUT(1, vec4, powers)

bool holds(uint i)
{
    return !is_finite(positions(i)) || !is_finite(powers(i));
}
