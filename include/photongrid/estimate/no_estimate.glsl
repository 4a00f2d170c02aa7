// The estimate while no photon has been summed yet.
struct Params {
    float radius2; // m^2
};
PARAMS(Params)
INPUT(0, uvec4, tallies) // y: photons visited
OUTPUT(0, vec4, irradiance)
OUTPUT(1, uvec2, used)

void kernel(uint i)
{
    irradiance = vec4(0.0f, 0.0f, 0.0f, args.radius2);
    used = uvec2(0u, tallies(i).y);
}
