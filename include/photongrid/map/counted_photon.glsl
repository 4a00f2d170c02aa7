// True for a photon that a map holds: finite, and of one of the parts of the light that the map is made of.
#include <photongrid/map/grid.glsl>

struct Params {
    uint parts; // other_part | caustic_part (map_buffers.hpp)
};
PARAMS(Params)
INPUT(0, vec4, positions)
INPUT(1, vec4, powers)

bool holds(uint i)
{
    return is_held(positions(i), powers(i), args.parts);
}
