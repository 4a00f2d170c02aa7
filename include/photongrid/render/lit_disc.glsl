// The disc of an estimate, if it has light: nothing has to be known of others.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, points)      // w: squared radius, m^2
INPUT(1, vec4, irradiances)
OUTPUT(0, vec4, point)      // w: 0 without light

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 e = irradiances(i);
    bool is_lit = e.x != 0.0f || e.y != 0.0f || e.z != 0.0f;
    point = vec4(p.x, p.y, p.z, is_lit ? p.w : 0.0f);
}
