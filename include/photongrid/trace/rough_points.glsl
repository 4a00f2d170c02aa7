// The ends of eye rays on rough surfaces as points that light falls on from one side, for shadow_ray.glsl.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/core/natural_exp.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint first;  // the eye ray of element 0
    uint behind; // 1: on the side away from the eye, of glass
};
PARAMS(Params)
SWITCH(4, MIRRORS)
SWITCH(5, GLASS)
INPUT(0, vec4, scene)
INPUT(1, vec4, points)
INPUT(2, vec4, directions)
INPUT(3, vec4, throughputs)
INPUT(4, vec4, surfaces)
INPUT(5, vec4, emissions)
OUTPUT(0, vec4, point)   // xyz, m; w: a point_code() where light may fall, else -1
OUTPUT(1, vec4, surface) // xyz: normal on the lit side; w: -1, no material: the light is not yet that below a coat

#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/optics.glsl>
#include <photongrid/trace/scatter.glsl>
#include <photongrid/trace/rough_end.glsl>

void kernel(uint i)
{
    uint ray = args.first + i;
    point = vec4(0.0f, 0.0f, 0.0f, -1.0f);
    surface = vec4(0.0f, 0.0f, 1.0f, -1.0f);
    if (!ended_on_rough(ray))
        return;
    Surface e = rough_end(ray);
    if (args.behind != 0u && !is_glass(e.material))
        return;
    vec3 end = vec3(points(ray));
    float side = args.behind != 0u ? -1.0f : 1.0f;
    // Shadow rays start off the surface about its shading normal, and from this point.
    vec3 p = ray_at(end, e.geometric, side * ray_offset(end, scene(SCENE_SIZES).z));
    uint inside = 0u;
    if (MEDIA) {
        Crossing c = crossing_at(ray, e);
        inside = args.behind != 0u ? c.behind : c.in_front;
    }
    point = vec4(p.x, p.y, p.z, point_code(inside));
    surface = vec4(e.shading.x * side, e.shading.y * side, e.shading.z * side, -1.0f);
}
