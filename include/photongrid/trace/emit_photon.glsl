// Frame 0 of the photon texture (2.1): photons on the lights, with random initial directions.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/trace/scene_layout.glsl>
#include <photongrid/trace/emission_guide.glsl>
#include <photongrid/trace/photon_event.glsl>

struct Params {
    uint first_path; // id of the path of element 0
    uint seed;
    uint boxes; // of the guide; 0: none
    uint ends;  // what ends paths: with ROUGH_ENDS those from lights with a size, which rays find, do not begin
};
PARAMS(Params)
INPUT(0, vec4, scene)
INPUT(1, uvec4, faces) // these four: see lights/mesh_light.glsl
INPUT(2, vec4, planes)
INPUT(3, vec4, vertices)
INPUT(4, uint, shares)
INPUT(5, vec4, environment)        // see environment.glsl ...
INPUT(6, uint, environment_shares) // ... and lights/environment_light.glsl
INPUT(7, vec4, guide)              // see emission_guide.glsl
OUTPUT(0, vec4, position)       // xyz, m; w: event, see photon_event.glsl
OUTPUT(1, vec4, power)          // rgb, W, not yet divided by the number of paths
OUTPUT(2, vec4, direction)      // of the photon
OUTPUT(3, vec4, next_origin)    // origin of the path's next ray ...
OUTPUT(4, vec4, next_direction) // ... and its direction; w: with MEDIA the inside_code of the light's place

#include <photongrid/trace/emission_numbers.glsl>
#include <photongrid/trace/lights.glsl>
#include <photongrid/trace/inside_code.glsl>

void kernel(uint i)
{
    uint id = args.first_path + i;
    EmissionNumbers drawn = emission_numbers(id);

    // Choose a light with a probability proportional to its power.
    Table lights = table_of(scene(LIGHT_TABLE));
    uint at = lights.first;
    for (uint n = 1u; n < lights.count; ++n) {
        if (drawn.second.x < cumulative_probability(at))
            break;
        at += lights.stride;
    }
    Emitted e = emitted_photon(at, drawn.first, drawn.second);
    precise vec3 weighted = e.power * drawn.weight;
    bool begins = args.ends != ROUGH_ENDS || scene(at).w == float(SAMPLED_ONCE);
    vec4 start = vec4(e.origin.x, e.origin.y, e.origin.z, 0.0f);
    position = vec4(start.x, start.y, start.z,
        begins ? 0.0f : event_code(NO_SURFACE, ENDED_BEFORE, NOTHING_BEFORE));
    power = vec4(weighted.x, weighted.y, weighted.z, 0.0f);
    direction = vec4(e.direction.x, e.direction.y, e.direction.z, 0.0f);
    next_origin = start;
    next_direction = vec4(e.direction.x, e.direction.y, e.direction.z,
        MEDIA ? inside_code(media_around(at), 1.0f) : 0.0f);
}
