// Traces an eye ray to the next surface (2.4), through mirrors and glass until it ends on a diffuse surface, on a
// light, or in empty space. At the first `splits` glass surfaces a ray splits into its two Fresnel branches: the bits
// of `branch` select the one that this pass follows at each. At later ones a random number selects it, stratified over
// the eye rays of a pixel.
#include <photongrid/backend/vector.glsl>
#include <photongrid/backend/random.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint branch;     // bit n: reflected (1) or refracted (0) at the n-th glass surface
    uint splits;     // how many glass surfaces split a ray
    uint depth;      // surfaces a ray passes at most
    float stratum;   // where this eye ray's random numbers begin in those of the pixel: its number / eye rays per pixel
    uint seed;
    uint first_pixel; // that of element 0
};
PARAMS(Params)
SWITCH(4, MIRRORS)
SWITCH(5, GLASS)
SWITCH(7, AREA_LIGHTS)
INPUT(0, vec4, scene)
STATE(0, vec4, point)      // xyz: origin, at the end the point hit, m; w: 0 in flight, 1 on a diffuse surface, else -1
STATE(1, vec4, direction)  // xyz: unit vector; w: surfaces hit
STATE(2, vec4, throughput) // rgb: factor between radiance here and at the eye; w: splits so far
STATE(3, vec4, surface)    // xyz: normal towards the eye; w: material
STATE(4, vec4, emitted)    // rgb: radiance of the light that the ray ended on, times throughput
STATE(5, uint, branches)   // bit b: branch b has light of its own

#include <photongrid/trace/intersect.glsl>
#include <photongrid/trace/lights.glsl>
#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/optics.glsl>

bool done()
{
    return point.w != 0.0f;
}

void kernel(uint i)
{
    vec3 d = vec3(direction);
    Hit hit = intersect_closest(vec3(point), d);
    uint hits = uint(direction.w);
    uint splits = uint(throughput.w);
    // A ray that hit fewer glass surfaces than there are splits is the same in several passes: count it in one of them,
    // the one whose unused branch bits are 0.
    bool mine = args.branch >> min(splits, 31u) == 0u; // a device that computes garbage may shift by anything
    if (hit.t < 0.0f) {
        point.w = -1.0f;
        return;
    }
    if (hit.material == NO_MATERIAL) {
        point.w = -1.0f;
        Light light = light_of(hit.light);
        float scale = light.radiance_per_power; // on the front only
        if (mine && dot3(d, hit.normal) < 0.0f)
            emitted = vec4(throughput.x * light.power.x * scale, throughput.y * light.power.y * scale,
                throughput.z * light.power.z * scale, 0.0f);
        return;
    }
    Material material = material_of(hit.material);
    if (material.kind == LAMBERTIAN_SURFACE) {
        vec3 n = dot3(hit.normal, d) > 0.0f ? -hit.normal : hit.normal;
        point = vec4(hit.position.x, hit.position.y, hit.position.z, mine ? 1.0f : -1.0f);
        surface = vec4(n.x, n.y, n.z, float(hit.material));
        return;
    }
    vec3 next = d;
    precise vec3 tinted = vec3(throughput) * material.reflectance;
    float share = 1.0f;
    if (MIRRORS && material.kind == MIRROR_SURFACE)
        next = reflect_direction(d, hit.normal);
    if (GLASS && material.kind == GLASS_SURFACE) {
        Fresnel f = fresnel(d, hit.normal, material.index_of_refraction);
        bool reflect_it = f.reflected >= 1.0f;
        if (splits < args.splits) {
            if (mine)
                branches = branches | 1u << min(args.branch | 1u << splits, 31u);
            reflect_it = ((args.branch >> splits) & 1u) != 0u;
            share = reflect_it ? f.reflected : 1.0f - f.reflected;
            ++splits;
        } else if (!reflect_it) {
            // A rare choice counts for much: with Fresnel's probability, a lamp that a faint ray sees by a reflection
            // of 4 % is a bright speck. The fainter the ray, the less rare is the rarer choice: up to 1 of 4.
            precise float least = 0.25f - 0.25f * max(max(throughput.x, throughput.y), throughput.z);
            float probability = min(max(f.reflected, least), 1.0f - least);
            vec4 r = random4(uvec4(i + args.first_pixel, args.branch, 2000u + hits, args.seed));
            precise float u = r.x + args.stratum;
            reflect_it = (u < 1.0f ? u : u - 1.0f) < probability;
            precise float corrected = reflect_it ? f.reflected / probability : (1.0f - f.reflected) / (1.0f - probability);
            share = corrected;
        }
        next = f.refracted;
        if (reflect_it)
            next = reflect_direction(d, hit.normal);
    }
    ++hits;
    if (hits > args.depth || !(share > 0.0f)) {
        point.w = -1.0f;
        return;
    }
    vec3 start = ray_start(hit.position, hit.normal, next);
    point = vec4(start.x, start.y, start.z, 0.0f);
    direction = vec4(next.x, next.y, next.z, float(hits));
    throughput = vec4(tinted.x * share, tinted.y * share, tinted.z * share, float(splits));
}
