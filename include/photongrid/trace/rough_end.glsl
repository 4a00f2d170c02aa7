// Where an eye ray ended on a rough surface (eye_bounce.glsl). Included by kernels after their INPUTs scene, points,
// directions, throughputs, surfaces and emissions.
#include <photongrid/trace/materials.glsl>

struct RoughEnd {
    vec3 position;  // m
    vec3 d;         // direction of the eye ray
    vec3 shading;   // unit; on the eye's side
    vec3 geometric; // unit; on the eye's side
    bool outside;   // the eye's side is
    Material material;
};

bool ended_on_rough(uint ray)
{
    return points(ray).w <= -2.0f;
}

RoughEnd rough_end(uint ray)
{
    vec4 way = directions(ray);
    vec4 facing = surfaces(ray);
    vec3 outward = vec3(way.w, throughputs(ray).w, emissions(ray).w);
    RoughEnd e;
    e.position = vec3(points(ray));
    e.d = vec3(way);
    e.shading = vec3(facing);
    e.outside = !(dot3(outward, e.d) > 0.0f);
    e.geometric = e.outside ? outward : -outward;
    e.material = material_of(uint(facing.w));
    precise float alpha = -2.0f - points(ray).w;
    e.material.alpha = alpha;
    return e;
}
