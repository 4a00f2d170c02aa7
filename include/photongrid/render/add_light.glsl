// Adds the light of some pixels to that of all.
struct Params {
    uint first; // pixel of element 0 of `more`
};
PARAMS(Params)
INPUT(0, vec4, more)
STATE(0, vec4, light)

void kernel(uint i)
{
    vec4 m = more(i - args.first);
    light = vec4(light.x + m.x, light.y + m.y, light.z + m.z, 0.0f);
}
