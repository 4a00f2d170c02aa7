// A ray from a point to a point of a parallelogram, for tests: is it occluded by shapes in the shaft, and by any shape?
#include <photongrid/core/vector.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
SWITCH(7, AREA_LIGHTS)
INPUT(0, vec4, scene)
INPUT(1, vec4, points)   // xyz: where the ray begins; w: the end point, a fraction of edge u
INPUT(2, vec4, corners)  // xyz: the parallelogram's corner; w: the end point, a fraction of edge v
INPUT(3, vec4, edges_u)
INPUT(4, vec4, edges_v)
OUTPUT(0, uvec4, answer) // blocked by the candidates, by anything; candidates: polygons, spheres

#include <photongrid/trace/intersect.glsl>

void kernel(uint i)
{
    vec3 from = vec3(points(i));
    vec3 corner = vec3(corners(i));
    vec3 u = vec3(edges_u(i));
    vec3 v = vec3(edges_v(i));
    precise vec3 ray = ray_at(ray_at(corner, u, points(i).w), v, corners(i).w) - from;
    precise float far = sqrt(dot3(ray, ray));
    precise vec3 d = ray / far;
    Candidates c = shaft(from, corner, u, v);
    answer = uvec4(occluded(from, d, far, c) ? 1u : 0u, occluded(from, d, far, everything()) ? 1u : 0u, c.polygons, c.spheres);
}
