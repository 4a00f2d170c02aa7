// True for a photon that is left out of a map made of some parts of the light only.
#include <photongrid/map/grid.glsl>

struct Params {
    uint parts;
};
PARAMS(Params)
INPUT(0, vec4, positions)

bool holds(uint i)
{
    return !is_of_parts(positions(i), args.parts);
}
