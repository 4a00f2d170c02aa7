// A point at each photon, for estimates there.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, positions)
OUTPUT(0, vec4, point)

void kernel(uint i)
{
    vec4 p = positions(i);
    point = vec4(p.x, p.y, p.z, 1.0f);
}
