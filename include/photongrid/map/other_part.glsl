// True for a photon that belongs to none of the parts of the light that the map is made of.
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
