// Frame 0 of the photon texture (2.1): photons on the light sources with their initial random directions.
#include "vector.glsl"
#include "random.glsl"
#include "scene_layout.glsl"

struct Params {
    Scene scene_layout;
    uint first_path; // id of the path of element 0
    uint seed;
};
PARAMS(Params)
SWITCH(6, POINT_LIGHTS)
SWITCH(7, AREA_LIGHTS)
INPUT(0, vec4, scene)
OUTPUT(0, vec4, position)       // xyz, m; w: event, see photon_event.glsl
OUTPUT(1, vec4, power)          // rgb, W, not yet divided by the number of paths
OUTPUT(2, vec4, direction)      // of arrival
OUTPUT(3, vec4, next_origin)    // where the path goes on from ...
OUTPUT(4, vec4, next_direction) // ... and where to

void kernel(uint i)
{
    uint id = args.first_path + i;
    vec4 r = random4(uvec4(id, 0u, 0u, args.seed));
    vec4 s = random4(uvec4(id, 0u, 1u, args.seed));

    // The light, chosen in proportion to its power.
    uint at = args.scene_layout.rest.y;
    for (uint n = 1u; n < args.scene_layout.rest.z; ++n) {
        if (s.x < scene(at).z)
            break;
        at += 6u;
    }
    vec4 head = scene(at); // kind, probability, cumulative probability
    vec3 origin = vec3(scene(at + 1u));
    vec3 d = vec3(0.0f, 0.0f, 1.0f);
    if (POINT_LIGHTS && (!AREA_LIGHTS || head.x == 0.0f))
        d = uniform_direction(r.x, r.y);
    if (AREA_LIGHTS && (!POINT_LIGHTS || head.x != 0.0f)) {
        vec3 normal = vec3(scene(at + 4u));
        vec3 edge_u = vec3(scene(at + 2u));
        vec3 edge_v = vec3(scene(at + 3u));
        // Rounding goes by the terms, which may be large where their sum is small.
        float off = clearance(abs(origin) + abs(edge_u) + abs(edge_v), args.scene_layout);
        origin = along(along(origin, edge_u, r.z), edge_v, r.w);
        d = cosine_direction(normal, r.x, r.y);
        origin = along(origin, normal, off);
    }
    vec4 flux = scene(at + 5u);
    position = vec4(origin.x, origin.y, origin.z, 0.0f);
    power = vec4(flux.x / head.y, flux.y / head.y, flux.z / head.y, 0.0f);
    direction = vec4(d.x, d.y, d.z, 0.0f);
    next_origin = vec4(origin.x, origin.y, origin.z, 0.0f);
    next_direction = vec4(d.x, d.y, d.z, 0.0f);
}
