// The shadow rays of one sample of one light, at the ends of eye rays, for a search among meshes: rays that no shape
// blocks. Like direct_light.glsl otherwise.
#include <photongrid/backend/vector.glsl>
#include <photongrid/backend/random.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uvec2 strata;     // strata along the two edges of an area light; their product is the number of samples
    uint light;       // number of the light
    uint sample_id;   // number of its sample
    uint first;       // the eye ray of element 0
    uint ray_id;      // sample x branches + branch
    uint seed;
    uint first_pixel; // pixel of eye ray 0
};
PARAMS(Params)
SWITCH(6, POINT_LIGHTS)
SWITCH(7, AREA_LIGHTS)
INPUT(0, vec4, scene)
INPUT(1, vec4, points)     // w > 0: compute direct light
INPUT(2, vec4, surfaces)   // xyz: normal
INPUT(3, uvec4, faces)     // these four: see mesh_light.glsl
INPUT(4, vec4, planes)
INPUT(5, vec4, vertices)
INPUT(6, uint, shares)
OUTPUT(0, vec4, origin)    // xyz, m; w: length, m; 0 where nothing need be searched
OUTPUT(1, vec4, direction) // xyz: unit vector; w: irradiance if no mesh blocks the ray, divided by the power, m^-2

#include <photongrid/trace/intersect.glsl>
#include <photongrid/trace/lights.glsl>
#include <photongrid/trace/light_sample.glsl>
#include <photongrid/trace/mesh_light.glsl>

// A sample of a mesh light: a random point of the sample's own part of the area.
LightSample mesh_light_sample(uint at, uint i, LitPoint lit)
{
    vec4 r = random4(
        uvec4(i + args.first_pixel, args.ray_id, 3000u + args.light, args.seed ^ (args.sample_id * 0x9E3779B1u)));
    precise float share = 1.0f / float(args.strata.x * args.strata.y);
    precise float u = (float(args.sample_id) + r.x) * share;
    EmittingPoint e = emitting_point(at, min(u, 0.99999994f), r.y, r.z);
    precise vec3 towards = e.position - lit.position;
    float distance2 = dot3(towards, towards);
    if (!(distance2 > 0.0f))
        return no_light(lit);
    precise float inverse = 1.0f / sqrt(distance2);
    precise vec3 d = towards * inverse;
    float cosine = dot3(d, lit.normal);
    float leaving = -dot3(d, e.normal);
    if (!(cosine > 0.0f) || !(leaving > 0.0f))
        return no_light(lit);
    // Radiance times area is power / pi.
    precise float per_power = cosine * leaving / distance2 * 3.18309886e-1f * share;
    return lit_from(ray_at(e.position, e.normal, e.offset), per_power, lit);
}

void kernel(uint i)
{
    origin = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    direction = vec4(0.0f, 0.0f, 1.0f, 0.0f);
    vec4 point = points(args.first + i);
    if (!(point.w > 0.0f))
        return;
    LitPoint lit = lit_point(vec3(point), vec3(surfaces(args.first + i)));
    Table lights = table_of(scene(LIGHT_TABLE));
    uint at = lights.first + lights.stride * args.light;
    LightSample found;
    if (is_mesh_light(at)) {
        found = mesh_light_sample(at, args.first + i, lit);
    } else {
        SeenLight seen = seen_light(at, lit);
        if (!seen.area && args.sample_id > 0u)
            return; // all samples of a point light are the same
        found = light_sample(seen, args.light, args.sample_id, args.first + i, lit);
    }
    if (!(found.per_power > 0.0f)
        || (found.has_ray && occluded(lit.origin, found.direction, found.far, everything())))
        return;
    origin = vec4(lit.origin.x, lit.origin.y, lit.origin.z, found.has_ray ? found.far : 0.0f);
    direction = vec4(found.direction.x, found.direction.y, found.direction.z, found.per_power);
}
