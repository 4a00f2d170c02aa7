// A sample of a light of any kind as seen from a point (2.4). Included by kernels after trace/intersect.glsl and the
// SWITCHes, INPUTs and args that it reads: strata, light, sample_id, branch, nth, seed, first_pixel.
#include <photongrid/trace/lights.glsl>
#include <photongrid/trace/lit_point.glsl>
#include <photongrid/trace/light_sample.glsl>
#include <photongrid/trace/mesh_light.glsl>
#include <photongrid/trace/spot_light.glsl>
#include <photongrid/trace/sphere_light.glsl>
#include <photongrid/trace/distant_light.glsl>
#include <photongrid/trace/environment.glsl>
#include <photongrid/trace/environment_sample.glsl>

// The random numbers of this sample, in pairs.
vec4 sample_numbers(uint i)
{
    return sequence4(args.nth,
        uvec4(i + args.first_pixel, args.branch, 3000u + args.light, args.seed ^ (args.sample_id * 0x9E3779B1u)));
}

// The share of a sample among all samples.
float sample_share()
{
    precise float share = 1.0f / float(args.strata.x * args.strata.y);
    return share;
}

// A point of this sample's stratum of the unit square.
vec2 stratified(vec2 r)
{
    uint row = args.sample_id / args.strata.x;
    uint column = args.sample_id - row * args.strata.x;
    precise vec2 at
        = vec2((float(column) + r.x) / float(args.strata.x), (float(row) + r.y) / float(args.strata.y));
    return vec2(min(at.x, 0.99999994f), min(at.y, 0.99999994f));
}

// A sample of a mesh light: a random point of the sample's own part of the area.
LightSample mesh_light_sample(uint at, uint i, LitPoint lit)
{
    vec4 r = sample_numbers(i);
    float share = sample_share();
    precise float u = (float(args.sample_id) + r.x) * share;
    EmittingPoint e = emitting_point(at, min(u, 0.99999994f), r.z, r.w);
    LightWay way = way_to(e.position, lit);
    float leaving = -dot3(way.direction, e.normal);
    if (!(way.distance2 > 0.0f) || !(way.cosine > 0.0f) || !(leaving > 0.0f))
        return no_light(lit);
    // Radiance times area is power / pi.
    precise float per_power = way.cosine * leaving / way.distance2 * 3.18309886e-1f * share;
    return lit_from(ray_at(e.position, e.normal, e.offset), per_power, lit);
}

// A sample of a sphere light: a direction that is even over the solid angle that the sphere takes up (Shirley, Wang and
// Zimmerman, Monte Carlo Techniques for Direct Lighting Calculations, 1996).
LightSample sphere_light_sample(uint at, uint i, LitPoint lit)
{
    vec4 record = scene(at + 1u);
    float radius = scene(at + 2u).x;
    precise vec3 to_centre = vec3(record) - lit.position;
    float distance2 = dot3(to_centre, to_centre);
    precise float sine2 = radius * radius / distance2;
    if (!(sine2 < 1.0f))
        return no_light(lit); // inside
    precise float cone = sine2 / (1.0f + sqrt(1.0f - sine2)); // 1 - cosine
    vec2 u = stratified(vec2(sample_numbers(i)));
    precise float below = cone * u.x;
    precise float off_axis2 = below * (2.0f - below);
    precise float off_axis = sqrt(off_axis2);
    vec2 circle = unit_circle(u.y);
    vec3 d = from_basis(
        vec3(off_axis * circle.x, off_axis * circle.y, 1.0f - below), normalized3(to_centre));
    float cosine = dot3(d, lit.normal);
    if (!(cosine > 0.0f))
        return no_light(lit);
    // The sphere's surface along d, then outward by the offset.
    precise float half_chord2 = radius * radius - distance2 * off_axis2;
    precise float t = dot3(d, to_centre) - sqrt(half_chord2 > 0.0f ? half_chord2 : 0.0f);
    vec3 normal = normalized3(ray_at(-to_centre, d, t));
    float end_radius = radius + sphere_light_offset(vec3(record), radius, lit.round_share);
    precise float per_power = record.w * cosine * 6.28318531f * cone * sample_share();
    return lit_from(ray_at(vec3(record), normal, end_radius), per_power, lit);
}

// A spotlight.
LightSample spot_light_sample(uint at, LitPoint lit)
{
    vec3 position = vec3(scene(at + 1u));
    LightWay way = way_to(position, lit);
    float intensity = spot_intensity(at, -way.direction);
    if (!(way.distance2 > 0.0f) || !(way.cosine > 0.0f) || !(intensity > 0.0f))
        return no_light(lit);
    float least2 = lit.offset * lit.offset; // as for a point light
    precise float per_power = way.cosine * intensity / (way.distance2 > least2 ? way.distance2 : least2);
    LightSample found = lit_from(position, per_power, lit);
    precise float short_of = found.far * 0.9999f; // it may touch a surface
    found.far = short_of;
    return found;
}

// Light from outside of the scene.
LightSample distant_sample(vec3 towards, float per_power, LitPoint lit)
{
    LightSample found = no_light(lit);
    float cosine = dot3(towards, lit.normal);
    if (!(cosine > 0.0f))
        return found;
    precise float received = per_power * cosine;
    found.per_power = received;
    found.has_ray = true;
    found.direction = towards;
    found.far = 3.0e38f;
    return found;
}

// A sample, and what lights of all kinds have in common.
struct ArrivingLight {
    LightSample found;
    vec3 power;               // factor on found.per_power
    float radiance_per_power; // m^-2 sr^-1; 0 of lights without size
    bool is_rectangle;
};

// Of light `number`, for eye ray i. `whole`: parts of a rectangle that are close are taken whole, by their form factor.
ArrivingLight arriving_light(uint number, uint i, bool whole, LitPoint lit)
{
    Table lights = table_of(scene(LIGHT_TABLE));
    uint at = lights.first + lights.stride * number;
    uint form = uint(scene(at).x);
    ArrivingLight a;
    a.found = no_light(lit);
    a.power = vec3(scene(at + 5u));
    a.radiance_per_power = 0.0f;
    a.is_rectangle = AREA_LIGHTS && form == RECTANGLE_LIGHT;
    if (is_mesh_light(at)) {
        a.found = mesh_light_sample(at, i, lit);
        a.radiance_per_power = scene(at + 1u).w;
    } else if (SPHERE_LIGHTS && form == SPHERE_LIGHT) {
        a.found = sphere_light_sample(at, i, lit);
        a.radiance_per_power = scene(at + 1u).w;
    } else if (ENVIRONMENT_LIGHTS && form == ENVIRONMENT_LIGHT) {
        vec4 r = sample_numbers(i);
        EnvironmentSample e = environment_sample(at, stratified(vec2(r)), vec2(r.z, r.w));
        a.found = distant_sample(e.towards, sample_share(), lit);
        a.power = e.radiance_per_density;
        a.radiance_per_power = e.density;
    } else if (SPOT_LIGHTS && form == SPOT_LIGHT) {
        a.found = spot_light_sample(at, lit);
    } else if (DIRECTIONAL_LIGHTS && form == DIRECTIONAL_LIGHT) {
        vec4 light = scene(at + 1u);
        a.found = distant_sample(-vec3(light), light.w, lit);
    } else if (POINT_LIGHTS || AREA_LIGHTS) {
        SeenLight seen = seen_light(at, lit);
        seen.some_close = seen.some_close && whole;
        a.found = light_sample(seen, number, args.sample_id, i, lit);
        if (seen.area)
            a.radiance_per_power = seen.light.radiance_per_power;
    }
    return a;
}
