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
OUTPUT(0, vec4, origin)    // xyz, m; w: length, m; 0 where nothing need be searched
OUTPUT(1, vec4, direction) // xyz: unit vector; w: irradiance if no mesh blocks the ray, divided by the power, m^-2

#include <photongrid/trace/intersect.glsl>
#include <photongrid/trace/lights.glsl>
#include <photongrid/trace/light_sample.glsl>

void kernel(uint i)
{
    origin = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    direction = vec4(0.0f, 0.0f, 1.0f, 0.0f);
    vec4 point = points(args.first + i);
    if (!(point.w > 0.0f))
        return;
    LitPoint lit = lit_point(vec3(point), vec3(surfaces(args.first + i)));
    Table lights = table_of(scene(LIGHT_TABLE));
    SeenLight seen = seen_light(lights.first + lights.stride * args.light, lit);
    if (!seen.area && args.sample_id > 0u)
        return; // all samples of a point light are the same
    LightSample found = light_sample(seen, args.light, args.sample_id, args.first + i, lit);
    if (!(found.per_power > 0.0f)
        || (found.has_ray && occluded(lit.origin, found.direction, found.far, everything())))
        return;
    origin = vec4(lit.origin.x, lit.origin.y, lit.origin.z, found.has_ray ? found.far : 0.0f);
    direction = vec4(found.direction.x, found.direction.y, found.direction.z, found.per_power);
}
