// What a surface does to a ray of direction `directions` by its four verbs (trace/scatter.glsl), for tests.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint way; // of scene_layout.glsl, or ANY_WAY
    uint seed;
};
PARAMS(Params)
const uint ANY_WAY = 3u; // of a sample, the one that its facet chooses; else that to the direction `towards`
SWITCH(4, MIRRORS)
SWITCH(5, GLASS)
INPUT(0, vec4, scene)
INPUT(1, vec4, directions) // xyz: of the ray; w: number of the material
INPUT(2, vec4, normals)    // xyz: outward
INPUT(3, vec4, towards)    // xyz: unit vector; of length 0: the sample's direction
INPUT(4, vec4, shadings)   // xyz: outward shading normal
OUTPUT(0, vec4, sampled)   // xyz: direction; w: the share of the light that goes there, and that nothing hides
OUTPUT(1, vec4, verbs)     // x: BSDF, sr^-1; y: density, sr^-1; z: 1 if it is a delta; w: radiance_scale of the sample
OUTPUT(2, vec4, colored)   // rgb: BSDF, sr^-1; w: its factor on the reflectance of the sample, green

#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/optics.glsl>
#include <photongrid/trace/scatter.glsl>

void kernel(uint i)
{
    vec4 d = directions(i);
    Hit hit;
    hit.t = 1.0f;
    hit.material = uint(d.w);
    hit.light = 0u;
    hit.position = vec3(0.0f, 0.0f, 0.0f);
    hit.normal = vec3(normals(i));
    hit.shading = vec3(shadings(i));
    vec4 r = random4(uvec4(i, 0u, 0u, args.seed));
    Surface s = surface_met(hit, vec3(d), material_of(hit.material));
    Facet facet = facet_met(s, r.x, r.y);
    bool any = args.way == ANY_WAY;
    s = leaving_by(s, any ? way_of(s, r.z < facet.f.reflected) : args.way);
    vec4 again = random4(uvec4(i, 2u, 0u, args.seed));
    Scattered l = scatter_sample(s, facet, r.x, r.y, again, uvec4(i, 1u, 0u, args.seed));
    float share = 1.0f;
    if (!any && s.material.kind != LAMBERTIAN_SURFACE && s.way != BY_BASE)
        share = s.way == BY_REFLECTION ? facet.f.reflected : 1.0f - facet.f.reflected;
    precise float leaving = share * l.unhidden;
    sampled = vec4(l.direction.x, l.direction.y, l.direction.z, leaving);
    vec3 from = vec3(towards(i));
    if (dot3(from, from) == 0.0f)
        from = l.direction;
    if (any)
        s.way = dot3(from, s.shading) > 0.0f ? BY_REFLECTION : BY_REFRACTION;
    vec3 bsdf = scatter_eval(s, from);
    colored = vec4(bsdf.x, bsdf.y, bsdf.z, l.tint.y);
    verbs = vec4(bsdf.x, scatter_pdf(s, from), is_delta(s) ? 1.0f : 0.0f, l.radiance_scale);
}
