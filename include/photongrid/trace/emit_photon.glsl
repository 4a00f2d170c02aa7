// Frame 0 of the photon texture (2.1): photons on the lights, with random initial directions.
#include <photongrid/backend/vector.glsl>
#include <photongrid/backend/random.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint first_path; // id of the path of element 0
    uint seed;
};
PARAMS(Params)
SWITCH(6, POINT_LIGHTS)
SWITCH(7, AREA_LIGHTS)
INPUT(0, vec4, scene)
INPUT(1, uvec4, faces) // these four: see mesh_light.glsl
INPUT(2, vec4, planes)
INPUT(3, vec4, vertices)
INPUT(4, uint, shares)
OUTPUT(0, vec4, position)       // xyz, m; w: event, see photon_event.glsl
OUTPUT(1, vec4, power)          // rgb, W, not yet divided by the number of paths
OUTPUT(2, vec4, direction)      // of the photon
OUTPUT(3, vec4, next_origin)    // origin of the path's next ray ...
OUTPUT(4, vec4, next_direction) // ... and its direction

#include <photongrid/trace/lights.glsl>
#include <photongrid/trace/mesh_light.glsl>

void kernel(uint i)
{
    uint id = args.first_path + i;
    vec4 r = random4(uvec4(id, 0u, 0u, args.seed));
    vec4 s = random4(uvec4(id, 0u, 1u, args.seed));

    // Choose a light with a probability proportional to its power.
    Table lights = table_of(scene(LIGHT_TABLE));
    uint at = lights.first;
    for (uint n = 1u; n < lights.count; ++n) {
        if (s.x < cumulative_probability(at))
            break;
        at += lights.stride;
    }
    Light light = light_at(at);
    float probability = light_probability(at);
    power = vec4(light.power.x / probability, light.power.y / probability, light.power.z / probability, 0.0f);
    vec3 origin = light.position;
    vec3 d = vec3(0.0f, 0.0f, 1.0f);
    bool of_mesh = is_mesh_light(at);
    if (of_mesh) {
        EmittingPoint e = emitting_point(at, s.y, r.z, r.w);
        d = cosine_direction(e.normal, r.x, r.y);
        origin = ray_at(e.position, e.normal, e.offset);
    }
    if (POINT_LIGHTS && !of_mesh && (!AREA_LIGHTS || !light.is_area))
        d = uniform_direction(r.x, r.y);
    if (AREA_LIGHTS && !of_mesh && (!POINT_LIGHTS || light.is_area)) {
        // The rounding error depends on the terms, which may be larger than their sum.
        float off = ray_offset(abs(origin) + abs(light.edge_u) + abs(light.edge_v), scene(SCENE_SIZES).x);
        origin = ray_at(ray_at(origin, light.edge_u, r.z), light.edge_v, r.w);
        d = cosine_direction(light.normal, r.x, r.y);
        origin = ray_at(origin, light.normal, off);
    }
    position = vec4(origin.x, origin.y, origin.z, 0.0f);
    direction = vec4(d.x, d.y, d.z, 0.0f);
    next_origin = vec4(origin.x, origin.y, origin.z, 0.0f);
    next_direction = vec4(d.x, d.y, d.z, 0.0f);
}
