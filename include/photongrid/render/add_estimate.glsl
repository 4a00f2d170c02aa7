// Adds estimates of another map at the same points. The radius stays.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, more)
STATE(0, vec4, irradiance) // rgb, W/m^2; w: squared radius, m^2

void kernel(uint i)
{
    vec4 m = more(i);
    irradiance = vec4(irradiance.x + m.x, irradiance.y + m.y, irradiance.z + m.z, irradiance.w);
}
