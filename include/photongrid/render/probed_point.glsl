// What glance.glsl and probe_disc.glsl have found, for estimates: the radius of each point's disc, and the share of it
// that lies on the surface, as divide_by_share.glsl reads it.
#include <photongrid/render/pixel_tile.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, points)   // w: squared radius of the disc, m^2
INPUT(1, uint, looked)   // see glance.glsl
INPUT(2, uint, searched) // searched_words.glsl
INPUT(3, uint, sums)     // inclusive prefix sums of their bits
INPUT(4, vec4, discs)    // of those probed: see probe_disc.glsl
INPUT(5, vec4, normals)
OUTPUT(0, vec4, point)   // w: squared radius that is left of it, m^2
OUTPUT(1, vec4, cover)   // x: share; y: 1: it is known
OUTPUT(2, uint, cut)     // SEARCHED: the disc was cut down or has a half space, else KEPT
OUTPUT(3, vec4, normal)  // w: half_space.glsl

#include <photongrid/render/search_number.glsl>

void kernel(uint i)
{
    cut = KEPT;
    vec4 n = normals(i);
    normal = vec4(n.x, n.y, n.z, 0.0f);
    vec4 p = points(i);
    bool known = p.w > 1.2e-38f; // see glance_ray.glsl
    point = p;
    cover = vec4(1.0f, known ? 1.0f : 0.0f, 0.0f, 0.0f);
    if (!known || looked(i) != SEARCHED)
        return;
    vec4 disc = discs(search_number(i));
    precise float left = p.w * (disc.w * disc.w);
    // The search needs a radius above 0 wherever there was one.
    point = vec4(p.x, p.y, p.z, max(left, 1.17549435e-38f));
    cover = vec4(disc.x, 1.0f, 0.0f, 0.0f);
    normal.w = disc.y;
    if (disc.w < 1.0f || disc.y > 0.0f)
        cut = SEARCHED;
}
