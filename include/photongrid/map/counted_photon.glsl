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
    return is_finite(positions(i)) && is_finite(powers(i)) && is_of_parts(positions(i), args.parts);
}
