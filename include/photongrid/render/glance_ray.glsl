// A slanted ray in one of four directions along the surface, for a glance (glance.glsl).
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/trace/scene_layout.glsl>
#include <photongrid/render/pixel_tile.glsl>

struct Params {
    uint number; // of the direction
};
PARAMS(Params)
INPUT(0, vec4, scene)
INPUT(1, vec4, points)  // xyz, m; w: squared radius of the disc, m^2; 0 or less: no estimate
INPUT(2, vec4, normals)
INPUT(3, uint, looked)  // of the directions before; the first reads none
OUTPUT(0, vec4, origin) // w: length, m; 0: there is no ray
OUTPUT(1, vec4, direction)

#include <photongrid/render/surface_way.glsl>

const float WAYS = 4.0f;

void kernel(uint i)
{
    origin = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    direction = vec4(0.0f, 0.0f, 1.0f, 0.0f);
    bool wanted = points(i).w > 1.2e-38f; // what shrunk_radius.glsl makes of 0 is no radius
    if (!wanted || (args.number > 0u && looked(i) == SEARCHED))
        return;
    precise float radius = sqrt(points(i).w);
    Slanted s = slanted_ray(i, float(args.number), WAYS, radius);
    origin = vec4(s.from.x, s.from.y, s.from.z, s.far);
    direction = vec4(s.d.x, s.d.y, s.d.z, 0.0f);
}
