// What probe_disc.glsl has found, for estimates: the radius of each point's disc, and the share of it that lies on the
// surface, as divide_by_share.glsl reads it.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, points) // w: squared radius of the disc, m^2
INPUT(1, vec4, discs)  // see probe_disc.glsl
OUTPUT(0, vec4, point) // w: squared radius that is left of it, m^2
OUTPUT(1, vec4, cover) // x: share; y: 1: it is known

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 disc = discs(i);
    bool known = disc.w > 0.0f;
    precise float left = p.w * (disc.w * disc.w);
    // The search needs a radius above 0 wherever there was one.
    point = vec4(p.x, p.y, p.z, known ? max(left, 1.17549435e-38f) : p.w);
    cover = vec4(disc.x, known ? 1.0f : 0.0f, 0.0f, 0.0f);
}
