// Traces an eye ray to the next surface (2.4), through mirrors and glass until it ends on a diffuse surface, on a
// light, or in the environment. The first `splits` times a ray splits: at glass into its two Fresnel branches; at a
// coat into one that it reflects and one that ends on the diffuse surface below; at a rough surface into one that ends
// there, for samples of lights, and one that goes on; at a mixture into its parts; and where a surface is clear in part
// into one that meets it and one that passes. The bits of `branch` select the one that this pass follows at
// each. Later a random number selects it, stratified over the eye rays of a pixel.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint branch;     // bit n, at the n-th split: reflected (1) or refracted, or below a coat (0); ends (1) at a rough
                     // surface or not (0); the second (1) or first part of a mixture; meets a surface (1) or passes
    uint splits;     // how often a ray splits at most
    uint depth;      // surfaces a ray passes at most
    float light_samples; // of each light with a size at rough surfaces; 0: such lights are left to rays
    uint nth;        // of the eye rays of a pixel, in all passes
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
// xyz: origin, at the end the point hit, m; w: 0 in flight, 1 on a diffuse surface, -2 - alpha on a rough one
// (rough_points.glsl), else -1
STATE(0, vec4, point)
STATE(1, vec4, direction)  // xyz: unit vector; w: surfaces hit
// rgb: factor between radiance here and at the eye; at the end on a diffuse surface between pi times its irradiance, or
// below a coat the part of that which passed, and radiance at the eye. w: splits so far
STATE(2, vec4, throughput)
// xyz: normal towards the eye; w: material. In flight, x: the density of the direction in which the ray left a rough
// surface, the last one that it met, sr^-1, else 0; y: how far it has come from there through clear ones, m
STATE(3, vec4, surface)
STATE(4, vec4, emitted)    // rgb: radiance of the light that the ray ended on, times throughput
STATE(5, uint, branches)   // bit b: branch b must be traced for this pixel; branch 0 sets the other bits

#include <photongrid/trace/intersect.glsl>
#include <photongrid/trace/mesh_hit.glsl>
#include <photongrid/trace/lights.glsl>
#include <photongrid/trace/environment.glsl>
#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/mixture.glsl>
#include <photongrid/trace/optics.glsl>
#include <photongrid/trace/shading_normals.glsl>
#include <photongrid/trace/rough_leaving.glsl>
#include <photongrid/trace/coat.glsl>
#include <photongrid/trace/met_surface.glsl>

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
    vec3 from = vec3(point);
    float far = hit.t;
    if (CLEAR) { // as seen from the rough surface
        precise vec3 start = from - d * surface.y;
        from = start;
        precise float whole = far + surface.y;
        far = whole;
    }
    if (SPHERE_LIGHTS && light.form == SPHERE_LIGHT) {
        float radius = light.edge_u.x;
        precise vec3 to_centre = light.position - from;
        precise float sine2 = radius * radius / dot3(to_centre, to_centre);
        if (!(sine2 < 1.0f))
            return 0.0f;
        precise float density = (1.0f + sqrt(1.0f - sine2)) / (6.28318531f * sine2);
        return density;
    }
    precise float density = far * far * 3.14159265f * light.radiance_per_power / -dot3(d, hit.normal);
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
void end_on_rough(Hit hit, vec3 shading, float alpha, vec3 weighted, bool counted)
{
    precise float code = -2.0f - alpha;
    point = vec4(hit.position.x, hit.position.y, hit.position.z, counted ? code : -1.0f);
    direction.w = hit.normal.x;
    throughput = vec4(weighted.x, weighted.y, weighted.z, hit.normal.y);
    emitted.w = hit.normal.z;
    surface = vec4(shading.x, shading.y, shading.z, float(hit.material));
}

// A random number that is stratified over the eye rays of a pixel.
float stratified_number(uint i, uint what)
{
    return sequence2(args.nth, uvec4(i + args.first_pixel, args.branch, what, args.seed)).x;
}

// Numbers that choose a facet, stratified too, and the same in all branches.
vec2 facet_numbers(uint i, uint hits)
{
    return sequence2(args.nth, uvec4(i + args.first_pixel, 0u, 4000u + hits, args.seed));
}

// The branch that a ray takes where it may be one of two, and the factor on its throughput. At glass and coats the
// first one is what they reflect; of a mixture the second part; of what is clear in part, what meets it.
struct Branch {
    bool first;
    float share;
};

// A ray that has split fewer than args.splits times is the same in several passes. Count it in one of them, the one
// whose unused branch bits are 0.
bool is_counted(uint splits)
{
    return args.branch >> min(splits, 31u) == 0u; // a device that computes garbage may shift by anything
}

// At a split, where other passes follow the other branch: the one that this pass follows. `share`: of the first branch.
// `counted`: is_counted() before the split.
Branch split_branch(uint splits, float share, bool counted)
{
    if (counted)
        branches = branches | 1u << min(args.branch | 1u << splits, 31u);
    Branch b;
    b.first = ((args.branch >> splits) & 1u) != 0u;
    b.share = b.first ? share : 1.0f - share;
    return b;
}

// Sampled with its probability, a 4 % reflection that reaches a lamp is a firefly. Sample the rarer branch more often
// as throughput falls, up to 1/4, and weight it accordingly. `what`: of the random number.
Branch sampled_branch(uint i, uint what, float share)
{
    Branch b;
    b.first = true; // total internal reflection
    b.share = 1.0f;
    if (!(share >= 1.0f)) {
        precise float least = 0.25f - 0.25f * max(max(throughput.x, throughput.y), throughput.z);
        float probability = min(max(share, least), 1.0f - least);
        b.first = stratified_number(i, what) < probability;
        precise float corrected = b.first ? share / probability : (1.0f - share) / (1.0f - probability);
        b.share = corrected;
    }
    return b;
}

// The branch that this pass follows, at a split or beyond the last one.
Branch branch_of(uint i, uint what, uint splits, float share, bool counted)
{
    if (splits < args.splits)
        return split_branch(splits, share, counted);
    return sampled_branch(i, what, share);
}

// What random numbers are for; the number of surfaces hit is added.
const uint FRESNEL = 2000u;
const uint PASSES = 10000u;
const uint PART = 20000u;

// The ray passes a surface that is clear in part.
void pass_clear(Hit hit, vec3 d, float share, uint splits)
{
    vec3 beyond = ray_start(hit.position, hit.normal, d);
    point = vec4(beyond.x, beyond.y, beyond.z, 0.0f);
    direction.w = direction.w + 1.0f;
    precise vec3 passed = vec3(throughput) * share;
    throughput = vec4(passed.x, passed.y, passed.z, float(splits));
    if (ROUGH) {
        precise float come = surface.y + hit.t;
        surface.y = come;
    }
}

void kernel(uint i)
{
    vec3 d = vec3(direction);
    Hit hit = intersect_closest(vec3(point), d);
    uint number = i - args.first; // of the hit on a mesh
    bool on_mesh = MESHES && mesh_is_closer(hit, number);
    if (on_mesh)
        hit = mesh_hit(number);
    uint hits = uint(direction.w);
    uint splits = uint(throughput.w);
    bool counted = is_counted(splits);
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
    float met = 1.0f; // the factor on throughput for what the ray has met of the surface
    if (CLEAR) {
        float opacity = opacity_at(hit.material, on_mesh, number);
        if (opacity < 1.0f) {
            Branch b;
            b.first = false;
            b.share = 1.0f;
            if (opacity > 0.0f) {
                b = branch_of(i, PASSES + hits, splits, opacity, counted);
                splits = min(splits + 1u, args.splits);
                counted = is_counted(splits);
            }
            if (!b.first) {
                if (hits + 1u > args.depth)
                    point.w = -1.0f;
                else
                    pass_clear(hit, d, b.share, splits);
                return;
            }
            met = b.share;
        }
    }
    uint part = 0u;
    if (MIXTURES && is_mixture(hit.material)) {
        Parts parts = parts_of(hit.material);
        float share_of_second = share_at(parts, on_mesh, number);
        Branch b;
        b.first = share_of_second > 0.0f;
        b.share = 1.0f;
        if (share_of_second > 0.0f && share_of_second < 1.0f) {
            b = branch_of(i, PART + hits, splits, share_of_second, counted);
            splits = min(splits + 1u, args.splits);
            counted = is_counted(splits);
        }
        part = b.first ? 1u : 0u;
        hit.material = b.first ? parts.second : parts.first;
        precise float both = met * b.share;
        met = both;
    }
    Material material = material_at(hit.material, part, on_mesh, number);
    FacingNormals sides = facing_normals(hit, d);
    bool coated = COATS && material.kind == COATED_SURFACE;
    bool below = false; // whether the ray passes the coat
    float share = 1.0f;
    if (coated) {
        Coat coat = coat_of(hit.material);
        precise float passed = passes_coat(coat, -dot3(sides.shading, d));
        precise float reflectance = 1.0f - passed;
        Branch b = branch_of(i, FRESNEL + hits, splits, reflectance, counted);
        splits = min(splits + 1u, args.splits);
        counted = is_counted(splits);
        below = !b.first;
        // The coat's reflectance follows, for the facet that the ray meets.
        precise float weight = below ? b.share / coat.mean_passed : (reflectance > 0.0f ? b.share / reflectance : 0.0f);
        share = weight;
        material.reflectance = below ? under_coat(coat, material.reflectance) : vec3(1.0f, 1.0f, 1.0f);
    }
    if (MIXTURES || CLEAR) {
        precise float of_met = share * met;
        share = of_met;
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
            ends = split_branch(splits, 1.0f, counted).first;
            ++splits;
            counted = is_counted(splits);
        } else {
            ends = stratified_number(i, 2500u + hits) < 0.5f;
            share = 2.0f;
        }
        if (ends) {
            precise vec3 weighted = tinted * share;
            end_on_rough(hit, sides.shading, material.alpha, weighted, counted);
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
        Branch b = branch_of(i, FRESNEL + hits, splits, f.reflected, counted);
        splits = min(splits + 1u, args.splits);
        reflected = b.first;
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
        surface.y = 0.0f;
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
