// Frame 0 of the photon texture (2.1): photons on the lights, with random initial directions.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/trace/scene_layout.glsl>
#include <photongrid/trace/emission_guide.glsl>

struct Params {
    uint first_path; // id of the path of element 0
    uint seed;
    uint boxes; // of the guide; 0: none
};
PARAMS(Params)
SWITCH(6, POINT_LIGHTS)
SWITCH(7, AREA_LIGHTS)
SWITCH(12, SPHERE_LIGHTS)
SWITCH(13, SPOT_LIGHTS)
SWITCH(14, DIRECTIONAL_LIGHTS)
SWITCH(15, ENVIRONMENT_LIGHTS)
INPUT(0, vec4, scene)
INPUT(1, uvec4, faces) // these four: see mesh_light.glsl
INPUT(2, vec4, planes)
INPUT(3, vec4, vertices)
INPUT(4, uint, shares)
INPUT(5, vec4, environment)        // see environment.glsl ...
INPUT(6, uint, environment_shares) // ... and environment_sample.glsl
INPUT(7, vec4, guide)              // see emission_guide.glsl
OUTPUT(0, vec4, position)       // xyz, m; w: event, see photon_event.glsl
OUTPUT(1, vec4, power)          // rgb, W, not yet divided by the number of paths
OUTPUT(2, vec4, direction)      // of the photon
OUTPUT(3, vec4, next_origin)    // origin of the path's next ray ...
OUTPUT(4, vec4, next_direction) // ... and its direction

#include <photongrid/trace/emission_numbers.glsl>
#include <photongrid/trace/lights.glsl>
#include <photongrid/trace/mesh_light.glsl>
#include <photongrid/trace/spot_light.glsl>
#include <photongrid/trace/sphere_light.glsl>
#include <photongrid/trace/distant_light.glsl>
#include <photongrid/trace/environment.glsl>
#include <photongrid/trace/environment_sample.glsl>

void kernel(uint i)
{
    uint id = args.first_path + i;
    EmissionNumbers drawn = emission_numbers(id);
    vec4 r = drawn.first;
    vec4 s = drawn.second;

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
    uint form = uint(scene(at).x);
    bool of_sphere = SPHERE_LIGHTS && form == SPHERE_LIGHT;
    bool of_spot = SPOT_LIGHTS && form == SPOT_LIGHT;
    bool of_direction = DIRECTIONAL_LIGHTS && form == DIRECTIONAL_LIGHT;
    bool of_environment = ENVIRONMENT_LIGHTS && form == ENVIRONMENT_LIGHT;
    bool other = of_mesh || of_sphere || of_spot || of_direction || of_environment;
    if (of_mesh) {
        EmittingPoint e = emitting_point(at, s.y, r.z, r.w);
        d = cosine_direction(e.normal, r.x, r.y);
        origin = ray_at(e.position, e.normal, e.offset);
    }
    if (of_sphere) {
        vec3 normal = uniform_direction(r.z, r.w);
        float radius = scene(at + 2u).x;
        d = cosine_direction(normal, r.x, r.y);
        origin = ray_at(origin, normal, radius + sphere_light_offset(origin, radius, scene(SCENE_SIZES).x));
    }
    if (of_spot)
        d = spot_direction(at, s.y, r.x, r.y, vec3(r.z, r.w, s.z));
    if (of_direction)
        d = vec3(scene(at + 1u));
    if (of_environment) {
        EnvironmentSample e = environment_sample(at, vec2(s.y, s.z), vec2(s.w, r.x));
        d = -e.towards;
        precise vec3 entering = e.radiance_per_density * (outline_area(at, d) / probability);
        power = vec4(entering.x, entering.y, entering.z, 0.0f);
    }
    if (of_direction || of_environment)
        origin = entry_point(at, d, r.y, r.z, r.w);
    if (POINT_LIGHTS && !other && (!AREA_LIGHTS || !light.is_area))
        d = uniform_direction(r.x, r.y);
    if (AREA_LIGHTS && !other && (!POINT_LIGHTS || light.is_area)) {
        // The rounding error depends on the terms, which may be larger than their sum.
        float off = ray_offset(abs(origin) + abs(light.edge_u) + abs(light.edge_v), scene(SCENE_SIZES).x);
        origin = ray_at(ray_at(origin, light.edge_u, r.z), light.edge_v, r.w);
        d = cosine_direction(light.normal, r.x, r.y);
        origin = ray_at(origin, light.normal, off);
    }
    precise vec4 weighted = power * drawn.weight;
    power = weighted;
    position = vec4(origin.x, origin.y, origin.z, 0.0f);
    direction = vec4(d.x, d.y, d.z, 0.0f);
    next_origin = vec4(origin.x, origin.y, origin.z, 0.0f);
    next_direction = vec4(d.x, d.y, d.z, 0.0f);
}
