// As many inputs and outputs as a kernel has at most, of every type.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uint, a)
INPUT(1, float, b)
INPUT(2, vec2, c)
INPUT(3, uvec2, d)
INPUT(4, vec4, e)
INPUT(5, uvec4, f)
INPUT(6, uint, g)
INPUT(7, float, h)
STATE(0, uint, p)
STATE(1, float, q)
STATE(2, vec2, r)
OUTPUT(3, uvec2, s)
STATE(4, vec4, t)
OUTPUT(5, uvec4, u)
OUTPUT(6, float, v)
OUTPUT(7, uint, w)

void kernel(uint i)
{
    p = p + a(i);
    q = q + b(i);
    r = r + c(i);
    s = uvec2(d(i).y, d(i).x);
    t = t + e(i);
    u = uvec4(f(i).w, f(i).z, f(i).y, f(i).x);
    v = h(i);
    w = g(i) + i;
}
