// Direct light at the points that eye rays ended on (2.4): shadow rays to every light, area lights sampled in strata, a
// bounded number in a pass. Irradiance, W/m^2.
#include "vector.glsl"
#include "random.glsl"
#include "scene_layout.glsl"

struct Params {
    Scene scene_layout;
    uvec2 strata;     // strata along the two edges of an area light; their product is the number of samples
    uint first;       // samples first ...
    uint past;        // ... to past - 1 are taken in this pass
    uint ray_id;      // which eye ray of the pixel
    uint seed;
};
PARAMS(Params)
SWITCH(0, SPHERES)
SWITCH(1, QUADRICS)
SWITCH(2, DISKS)
SWITCH(3, POLYGONS)
SWITCH(6, POINT_LIGHTS)
SWITCH(7, AREA_LIGHTS)
INPUT(0, vec4, scene)
INPUT(1, vec4, points)   // w > 0: wanted
INPUT(2, vec4, surfaces) // xyz: normal
STATE(0, vec4, irradiance)

#include "scene_hit.glsl"

void kernel(uint i)
{
    vec4 point = points(i);
    if (!(point.w > 0.0f))
        return;
    vec3 p = vec3(point);
    vec3 n = vec3(surfaces(i));
    vec3 origin = along(p, n, args.scene_layout.scale.x);
    vec3 sum = vec3(irradiance);
    float share = 1.0f / float(args.strata.x * args.strata.y);
    uint at = args.scene_layout.rest.y;
    for (uint light = 0u; light < args.scene_layout.rest.z; ++light) {
        vec4 head = scene(at);
        vec4 corner = scene(at + 1u);
        vec4 normal = scene(at + 4u);
        vec3 flux = vec3(scene(at + 5u));
        bool area = AREA_LIGHTS && (!POINT_LIGHTS || head.x != 0.0f);
        uint past = area ? args.past : 1u; // a point light's samples would all be the same
        for (uint s = args.first; s < past; ++s) {
            vec3 target = vec3(corner);
            if (area) {
                vec4 r = random4(uvec4(i, args.ray_id, 3000u + light, args.seed ^ (s * 0x9E3779B1u)));
                uint row = s / args.strata.x;
                float u = (float(s - row * args.strata.x) + r.x) / float(args.strata.x);
                float v = (float(row) + r.y) / float(args.strata.y);
                target = along(along(target, vec3(scene(at + 2u)), u), vec3(scene(at + 3u)), v);
            }
            precise vec3 towards = target - p;
            float distance2 = dot3(towards, towards);
            if (!(distance2 > 0.0f))
                continue;
            precise float inverse = 1.0f / sqrt(distance2);
            precise vec3 d = towards * inverse;
            float cosine = dot3(d, n);
            if (!(cosine > 0.0f))
                continue;
            precise float factor = cosine / distance2 * 7.95774715e-2f; // 1 / (4 pi): intensity of a point light
            if (area) {
                float leaving = -dot3(d, vec3(normal));
                if (!(leaving > 0.0f))
                    continue;
                precise float diffuse = cosine * leaving / distance2 * 3.18309886e-1f * share; // radiance x area = power / pi
                factor = diffuse;
            }
            precise vec3 ray = target - origin;
            float length2 = dot3(ray, ray);
            if (!(length2 > 0.0f))
                continue;
            precise float reach = sqrt(length2);
            precise vec3 ray_d = ray / reach;
            if (is_blocked(origin, ray_d, reach * 0.9999f))
                continue;
            precise vec3 more = sum + flux * factor;
            sum = more;
        }
        at += 6u;
    }
    irradiance = vec4(sum.x, sum.y, sum.z, 0.0f);
}
