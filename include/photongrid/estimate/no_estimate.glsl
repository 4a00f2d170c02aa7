// The estimate while no photon has been summed yet.
#include <photongrid/estimate/search_tally.glsl>

struct Params {
    float radius2; // m^2
};
PARAMS(Params)
INPUT(0, uvec4, tallies) // see search_tally.glsl
OUTPUT(0, vec4, irradiance)
OUTPUT(1, uvec2, used)

void kernel(uint i)
{
    irradiance = vec4(0.0f, 0.0f, 0.0f, args.radius2);
    used = uvec2(0u, photons_visited(tallies(i)));
}
