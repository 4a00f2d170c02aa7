// Traces an eye ray to the next surface (2.4), through mirrors and glass until it ends on a diffuse surface, on a
// light, or in the environment. At the first `splits` glass surfaces a ray splits into its two Fresnel branches: the
// bits of `branch` select the one that this pass follows at each. At later ones a random number selects it, stratified
// over the eye rays of a pixel.
#include <photongrid/backend/vector.glsl>
#include <photongrid/backend/random.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint branch;     // bit n: reflected (1) or refracted (0) at the n-th glass surface
    uint splits;     // how many glass surfaces split a ray
    uint depth;      // surfaces a ray passes at most
    float stratum;   // number of the eye ray in its pixel / eye rays per pixel: shifts its random numbers
    uint seed;
    uint first_pixel; // pixel of element 0
    uint first;       // the eye ray of mesh hit 0
};
PARAMS(Params)
SWITCH(4, MIRRORS)
SWITCH(5, GLASS)
SWITCH(7, AREA_LIGHTS)
SWITCH(15, ENVIRONMENT_LIGHTS)
INPUT(0, vec4, scene)
INPUT(1, vec4, mesh_places) // these three: see mesh_surface.glsl
INPUT(2, vec4, mesh_normals)
INPUT(3, vec4, mesh_shadings)
INPUT(4, vec4, environment) // see environment.glsl
INPUT(5, vec4, mesh_colors) // see mesh_color.glsl
STATE(0, vec4, point)      // xyz: origin, at the end the point hit, m; w: 0 in flight, 1 on a diffuse surface, else -1
STATE(1, vec4, direction)  // xyz: unit vector; w: surfaces hit
STATE(2, vec4, throughput) // rgb: factor between radiance here and at the eye; w: splits so far
STATE(3, vec4, surface)    // xyz: normal towards the eye; w: material
STATE(4, vec4, emitted)    // rgb: radiance of the light that the ray ended on, times throughput
STATE(5, uint, branches)   // bit b: branch b must be traced for this pixel; branch 0 sets the other bits

#include <photongrid/trace/intersect.glsl>
#include <photongrid/trace/mesh_hit.glsl>
#include <photongrid/trace/lights.glsl>
#include <photongrid/trace/environment.glsl>
#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/optics.glsl>
#include <photongrid/trace/shading_normals.glsl>

bool done()
{
    return point.w != 0.0f;
}

// The ray ends on the front of this light.
void see_light(uint number)
{
    Light light = light_of(number);
    float scale = light.radiance_per_power;
    emitted = vec4(throughput.x * light.power.x * scale, throughput.y * light.power.y * scale,
        throughput.z * light.power.z * scale, 0.0f);
}

// The Fresnel branch that a ray takes at a glass surface, and the factor on its throughput.
struct FresnelBranch {
    bool reflected;
    float share;
};

// At a split, where other passes follow the other branch: the one that this pass follows. `counted`: whether this
// pass counts the ray so far (kernel).
FresnelBranch split_branch(uint splits, float reflectance, bool counted)
{
    if (counted)
        branches = branches | 1u << min(args.branch | 1u << splits, 31u);
    FresnelBranch b;
    b.reflected = ((args.branch >> splits) & 1u) != 0u;
    b.share = b.reflected ? reflectance : 1.0f - reflectance;
    return b;
}

// Sampled with its Fresnel probability, a 4 % reflection that reaches a lamp is a firefly. Sample the rarer branch more
// often as throughput falls, up to 1/4, and weight it accordingly.
FresnelBranch sampled_branch(uint i, uint hits, float reflectance)
{
    FresnelBranch b;
    b.reflected = true; // total internal reflection
    b.share = 1.0f;
    if (!(reflectance >= 1.0f)) {
        precise float least = 0.25f - 0.25f * max(max(throughput.x, throughput.y), throughput.z);
        float probability = min(max(reflectance, least), 1.0f - least);
        vec4 r = random4(uvec4(i + args.first_pixel, args.branch, 2000u + hits, args.seed));
        precise float u = r.x + args.stratum;
        b.reflected = (u < 1.0f ? u : u - 1.0f) < probability;
        precise float corrected = b.reflected ? reflectance / probability : (1.0f - reflectance) / (1.0f - probability);
        b.share = corrected;
    }
    return b;
}

void kernel(uint i)
{
    vec3 d = vec3(direction);
    Hit hit = intersect_closest(vec3(point), d);
    bool on_mesh = MESHES && mesh_is_closer(hit, i - args.first);
    if (on_mesh)
        hit = mesh_hit(i - args.first);
    uint hits = uint(direction.w);
    uint splits = uint(throughput.w);
    // A ray that has split fewer than `splits` times is the same in several passes. Count it in one of them, the one
    // whose unused branch bits are 0.
    bool counted = args.branch >> min(splits, 31u) == 0u; // a device that computes garbage may shift by anything
    if (hit.t < 0.0f) {
        point.w = -1.0f;
        if (ENVIRONMENT_LIGHTS && counted) {
            vec3 seen = environment_radiance(environment_light(), d);
            emitted = vec4(throughput.x * seen.x, throughput.y * seen.y, throughput.z * seen.z, 0.0f);
        }
        return;
    }
    if (hit.material == NO_MATERIAL) {
        point.w = -1.0f;
        if (counted && dot3(d, hit.normal) < 0.0f) // on the front only
            see_light(hit.light);
        return;
    }
    Material material = material_of(hit.material);
    if (TEXTURES && on_mesh) {
        precise vec3 colored = vec3(throughput) * vec3(mesh_colors(i - args.first));
        throughput = vec4(colored.x, colored.y, colored.z, throughput.w);
    }
    FacingNormals sides = facing_normals(hit, d);
    if (material.kind == LAMBERTIAN_SURFACE) {
        vec3 p = hit.position;
        if (SMOOTH) // shadow rays start off the surface about its shading normal
            p = ray_start(p, sides.geometric, sides.geometric);
        point = vec4(p.x, p.y, p.z, counted ? 1.0f : -1.0f);
        surface = vec4(sides.shading.x, sides.shading.y, sides.shading.z, float(hit.material));
        return;
    }
    vec3 next = d;
    precise vec3 tinted = vec3(throughput) * material.reflectance;
    float share = 1.0f;
    if (MIRRORS && material.kind == MIRROR_SURFACE)
        next = leave_specular(hit, sides, total_reflection(d), true, 1.0f, d).direction;
    if (GLASS && material.kind == GLASS_SURFACE) {
        Fresnel f = fresnel(d, outward_normal(hit, sides, d), material.index_of_refraction);
        FresnelBranch b;
        if (splits < args.splits) {
            b = split_branch(splits, f.reflected, counted);
            ++splits;
        } else {
            b = sampled_branch(i, hits, f.reflected);
        }
        next = leave_specular(hit, sides, f, b.reflected, material.index_of_refraction, d).direction;
        precise float scaled = b.reflected ? b.share : b.share * f.radiance_scale;
        share = scaled;
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
