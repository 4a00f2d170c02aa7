// One ray against the scene, for tests: where it hits, the normal there, and where a ray that leaves would start.
#include <photongrid/core/vector.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
SWITCH(7, AREA_LIGHTS)
INPUT(0, vec4, scene)
INPUT(1, vec4, origins)
INPUT(2, vec4, directions)
INPUT(3, vec4, leavings)  // xyz: directions in which rays leave the hits; w: length of the shadow ray, or 0: any
OUTPUT(0, vec4, place)    // xyz: position; w: t, negative for a miss
OUTPUT(1, vec4, facing)   // xyz: normal; w: material, -1 for a light
OUTPUT(2, vec4, start)    // xyz: where the ray that leaves starts; w: 1 if the shadow ray from o in direction d is occluded

#include <photongrid/trace/intersect.glsl>

void kernel(uint i)
{
    vec3 o = vec3(origins(i));
    vec3 d = vec3(directions(i));
    Hit hit = intersect_closest(o, d);
    place = vec4(hit.position.x, hit.position.y, hit.position.z, hit.t);
    facing = vec4(hit.normal.x, hit.normal.y, hit.normal.z, hit.material == NO_MATERIAL ? -1.0f : float(hit.material));
    vec3 s = ray_start(hit, vec3(leavings(i)));
    float far = leavings(i).w > 0.0f ? leavings(i).w : 3.0e38f;
    start = vec4(s.x, s.y, s.z, occluded(o, d, far, everything()) ? 1.0f : 0.0f);
}
