// Direct light at the ends of eye rays (2.4): shadow rays to every light, with stratified samples of area lights. The
// number of samples per pass is bounded. Irradiance, W/m^2. Scenes with meshes: shadow_ray.glsl.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uvec2 strata;     // strata along the two edges of an area light; their product is the number of samples
    uint first;       // this pass takes samples first ...
    uint past;        // ... to past - 1
    uint branch;      // Fresnel branch of the eye rays (eye_bounce.glsl)
    uint nth;         // of the eye rays of a pixel, in all passes
    uint seed;
    uint first_pixel; // pixel of element 0
};
PARAMS(Params)
INPUT(0, vec4, scene)
INPUT(1, vec4, points)   // w > 0: compute direct light
INPUT(2, vec4, surfaces) // xyz: normal
STATE(0, vec4, irradiance)

#include <photongrid/trace/light_record.glsl>
#include <photongrid/trace/lit_point.glsl>
#include <photongrid/trace/lights/point_light.glsl>
#include <photongrid/trace/lights/rectangle_light.glsl>
#include <photongrid/trace/light_sample.glsl>
#include <photongrid/trace/intersect.glsl>

void kernel(uint i)
{
    vec4 point = points(i);
    if (!(point.w > 0.0f))
        return;
    LitPoint lit = lit_point(vec3(point), vec3(surfaces(i)));
    vec3 sum = vec3(irradiance);
    Table lights = table_of(scene(LIGHT_TABLE));
    uint at = lights.first;
    for (uint number = 0u; number < lights.count; ++number) {
        SeenLight seen = seen_light(at, lit);
        Candidates between = everything();
        if (seen.area)
            between = shaft(lit.origin, ray_at(seen.light.position, seen.off_light, 1.0f), seen.light.edge_u,
                seen.light.edge_v);
        uint past = seen.area ? args.past : 1u; // all samples of a point light are the same
        for (uint s = args.first; s < past; ++s) {
            LightSample found = light_sample(seen, number, s, i, lit);
            if (!(found.per_power > 0.0f)
                || (found.has_ray && occluded(lit.origin, found.direction, found.far, between)))
                continue;
            precise vec3 more = sum + seen.light.power * found.per_power;
            sum = more;
        }
        at += lights.stride;
    }
    irradiance = vec4(sum.x, sum.y, sum.z, 0.0f);
}
