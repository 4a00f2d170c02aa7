// Traces an eye ray to the next surface (2.4), through mirrors and glass until it ends on a diffuse surface, on a
// light, or in the environment. The first `splits` times a ray splits: at glass into its two Fresnel branches; at a
// coat into one that it reflects and one that ends on the diffuse surface below; at a rough surface into one that ends
// there, for samples of lights, and one that goes on. The bits of `branch` select the one that this pass follows at
// each. Later a random number selects it, stratified over the eye rays of a pixel.
#include <photongrid/backend/vector.glsl>
#include <photongrid/backend/random.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint branch;     // bit n, at the n-th split: reflected (1) or refracted, or below a coat (0); ends (1) at a rough
                     // surface or not (0)
    uint splits;     // how often a ray splits at most
    uint depth;      // surfaces a ray passes at most
    uint sample_id;  // number of the eye ray in its pixel
    float light_samples; // of each light with a size at rough surfaces; 0: such lights are left to rays
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
// xyz: origin, at the end the point hit, m; w: 0 in flight, 1 on a diffuse surface, -2 on a rough one
// (rough_points.glsl), else -1
STATE(0, vec4, point)
STATE(1, vec4, direction)  // xyz: unit vector; w: surfaces hit
// rgb: factor between radiance here and at the eye; at the end on a diffuse surface between pi times its irradiance, or
// below a coat the part of that which passed, and radiance at the eye. w: splits so far
STATE(2, vec4, throughput)
// xyz: normal towards the eye; w: material. In flight, x: the density of the direction in which the ray left a rough
// surface, the last one that it met, sr^-1; else 0
STATE(3, vec4, surface)
STATE(4, vec4, emitted)    // rgb: radiance of the light that the ray ended on, times throughput
STATE(5, uint, branches)   // bit b: branch b must be traced for this pixel; branch 0 sets the other bits

#include <photongrid/trace/intersect.glsl>
#include <photongrid/trace/mesh_hit.glsl>
#include <photongrid/trace/lights.glsl>
#include <photongrid/trace/environment.glsl>
#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/optics.glsl>
#include <photongrid/trace/shading_normals.glsl>
#include <photongrid/trace/rough_leaving.glsl>
#include <photongrid/trace/coat.glsl>

bool done()
{
    return point.w != 0.0f;
}

// The weight of a light that the ray hits. If it comes from a rough surface, samples of lights may find this one there,
// too (balance heuristic); `density`: that of such a sample's direction, sr^-1.
float weight_of_hit(float density)
{
    if (!ROUGH || !(surface.x > 0.0f) || args.light_samples == 0.0f)
        return 1.0f;
    precise float weight = surface.x / (surface.x + args.light_samples * density);
    return weight;
}

// The density of the samples of this light, which the ray hits on its front: see mesh_light_sample and
// sphere_light_sample.
float sampled_density(Light light, Hit hit, vec3 d)
{
    if (SPHERE_LIGHTS && light.form == SPHERE_LIGHT) {
        float radius = light.edge_u.x;
        precise vec3 to_centre = light.position - vec3(point);
        precise float sine2 = radius * radius / dot3(to_centre, to_centre);
        if (!(sine2 < 1.0f))
            return 0.0f;
        precise float density = (1.0f + sqrt(1.0f - sine2)) / (6.28318531f * sine2);
        return density;
    }
    precise float density = hit.t * hit.t * 3.14159265f * light.radiance_per_power / -dot3(d, hit.normal);
    return density;
}

// The ray ends on the front of this light.
void see_light(Hit hit, vec3 d)
{
    Light light = light_of(hit.light);
    float scale = light.radiance_per_power;
    if (ROUGH) {
        precise float weighted = scale * weight_of_hit(sampled_density(light, hit, d));
        scale = weighted;
    }
    emitted = vec4(throughput.x * light.power.x * scale, throughput.y * light.power.y * scale,
        throughput.z * light.power.z * scale, 0.0f);
}

// The ray ends on a rough surface, for samples of lights (rough_points.glsl). w of direction, throughput and emitted:
// the geometric normal.
void end_on_rough(Hit hit, vec3 shading, vec3 weighted, bool counted)
{
    point = vec4(hit.position.x, hit.position.y, hit.position.z, counted ? -2.0f : -1.0f);
    direction.w = hit.normal.x;
    throughput = vec4(weighted.x, weighted.y, weighted.z, hit.normal.y);
    emitted.w = hit.normal.z;
    surface = vec4(shading.x, shading.y, shading.z, float(hit.material));
}

// A random number that is stratified over the eye rays of a pixel.
float stratified_number(uint i, uint what)
{
    vec4 r = random4(uvec4(i + args.first_pixel, args.branch, what, args.seed));
    precise float u = r.x + args.stratum;
    return u < 1.0f ? u : u - 1.0f;
}

// Numbers that choose a facet, the same in all passes that trace this ray. On the first surface those of a pixel's eye
// rays are spread evenly from a random start on, by the generalized golden ratio (Roberts, The Unreasonable
// Effectiveness of Quasirandom Sequences, 2018).
vec2 facet_numbers(uint i, uint hits)
{
    bool first = hits == 0u;
    uvec4 bits = hash4(uvec4(i + args.first_pixel, first ? 0u : args.sample_id, 4000u + hits, args.seed));
    if (first) {
        bits.x += args.sample_id * 0xC13FA9A9u;
        bits.y += args.sample_id * 0x91E10DA5u;
    }
    return vec2(unit_float(bits.x), unit_float(bits.y));
}

// The Fresnel branch that a ray takes at glass or at a coat, and the factor on its throughput.
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
        b.reflected = stratified_number(i, 2000u + hits) < probability;
        precise float corrected = b.reflected ? reflectance / probability : (1.0f - reflectance) / (1.0f - probability);
        b.share = corrected;
    }
    return b;
}

// The branch that this pass follows, at a split or beyond the last one.
FresnelBranch fresnel_branch(uint i, uint hits, uint splits, float reflectance, bool counted)
{
    if (splits < args.splits)
        return split_branch(splits, reflectance, counted);
    return sampled_branch(i, hits, reflectance);
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
            EnvironmentSeen e = environment_seen(environment_light(), d);
            vec3 seen = e.radiance;
            if (ROUGH) {
                precise vec3 weighted = seen * weight_of_hit(e.density);
                seen = weighted;
            }
            emitted = vec4(throughput.x * seen.x, throughput.y * seen.y, throughput.z * seen.z, 0.0f);
        }
        return;
    }
    if (hit.material == NO_MATERIAL) {
        point.w = -1.0f;
        if (counted && dot3(d, hit.normal) < 0.0f) // on the front only
            see_light(hit, d);
        return;
    }
    Material material = material_of(hit.material);
    if (TEXTURES && on_mesh) {
        precise vec3 colored = material.reflectance * vec3(mesh_colors(i - args.first));
        material.reflectance = colored;
    }
    FacingNormals sides = facing_normals(hit, d);
    bool coated = COATS && material.kind == COATED_SURFACE;
    bool below = false; // whether the ray passes the coat
    float share = 1.0f;
    if (coated) {
        Coat coat = coat_of(hit.material);
        precise float passed = passes_coat(coat, -dot3(sides.shading, d));
        precise float reflectance = 1.0f - passed;
        FresnelBranch b = fresnel_branch(i, hits, splits, reflectance, counted);
        splits = min(splits + 1u, args.splits);
        counted = args.branch >> min(splits, 31u) == 0u;
        below = !b.reflected;
        // The coat's reflectance follows, for the facet that the ray meets.
        precise float weight = below ? b.share / coat.mean_passed : (reflectance > 0.0f ? b.share / reflectance : 0.0f);
        share = weight;
        material.reflectance = below ? under_coat(coat, material.reflectance) : vec3(1.0f, 1.0f, 1.0f);
    }
    precise vec3 tinted = vec3(throughput) * material.reflectance * share;
    if (material.kind == LAMBERTIAN_SURFACE || below) {
        vec3 p = hit.position;
        if (SMOOTH) // shadow rays start off the surface about its shading normal
            p = ray_start(p, sides.geometric, sides.geometric);
        point = vec4(p.x, p.y, p.z, counted ? 1.0f : -1.0f);
        throughput = vec4(tinted.x, tinted.y, tinted.z, throughput.w);
        surface = vec4(sides.shading.x, sides.shading.y, sides.shading.z, float(hit.material));
        return;
    }
    if (hits + 1u > args.depth) {
        point.w = -1.0f;
        return;
    }
    share = 1.0f;
    bool rough = ROUGH && material.alpha > 0.0f;
    if (rough) {
        // Some rays end here for samples of lights: in a pass of their own, or every other one.
        bool ends = false;
        if (splits < args.splits) {
            ends = split_branch(splits, 1.0f, counted).reflected;
            ++splits;
            counted = args.branch >> min(splits, 31u) == 0u;
        } else {
            ends = stratified_number(i, 2500u + hits) < 0.5f;
            share = 2.0f;
        }
        if (ends) {
            precise vec3 weighted = tinted * share;
            end_on_rough(hit, sides.shading, weighted, counted);
            return;
        }
    }
    vec3 outward = coated ? sides.shading : outward_normal(hit, sides, d);
    vec3 facet = sides.shading;
    if (rough) {
        vec2 r = facet_numbers(i, hits);
        facet = facet_met(sides, material.alpha, d, r.x, r.y);
        outward = coated ? facet : outward_facet(hit, facet, d);
    }
    Fresnel f = total_reflection(d);
    bool reflected = true;
    if (coated) {
        precise float scaled = share * fresnel(d, outward, material.index_of_refraction).reflected;
        share = scaled;
    }
    if (GLASS && material.kind == GLASS_SURFACE) {
        f = fresnel(d, outward, material.index_of_refraction);
        FresnelBranch b = fresnel_branch(i, hits, splits, f.reflected, counted);
        splits = min(splits + 1u, args.splits);
        reflected = b.reflected;
        precise float scaled = share * (reflected ? b.share : b.share * f.radiance_scale);
        share = scaled;
    }
    vec3 next = d;
    if (rough) {
        RoughLeaving l = leave_rough(sides, facet, material.alpha, f, reflected, d);
        next = l.direction;
        precise float unhidden_share = share * l.share;
        share = unhidden_share;
        surface.x = rough_scattering(sides.shading, material, !(dot3(hit.normal, d) > 0.0f), d, next).density;
    } else if (MIRRORS || GLASS) {
        if (ROUGH)
            surface.x = 0.0f;
        next = leave_specular(hit, sides, f, reflected, material.index_of_refraction, d).direction;
    }
    if (!(share > 0.0f)) {
        point.w = -1.0f;
        return;
    }
    vec3 start = ray_start(hit.position, hit.normal, next);
    point = vec4(start.x, start.y, start.z, 0.0f);
    direction = vec4(next.x, next.y, next.z, float(hits + 1u));
    throughput = vec4(tinted.x * share, tinted.y * share, tinted.z * share, float(splits));
}
