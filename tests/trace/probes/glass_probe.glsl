// Light meets a surface of glass, for tests.
#include <photongrid/core/vector.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, directions)
INPUT(1, vec4, normals)    // xyz: outward; w: index of refraction
OUTPUT(0, vec4, refracted) // xyz: direction; w: reflected share
OUTPUT(1, vec4, mirror)    // xyz: direction

#include <photongrid/trace/optics.glsl>

void kernel(uint i)
{
    vec4 normal = normals(i);
    Fresnel f = fresnel(vec3(directions(i)), vec3(normal), normal.w);
    refracted = vec4(f.refracted.x, f.refracted.y, f.refracted.z, f.reflected);
    vec3 m = reflect_direction(vec3(directions(i)), vec3(normal));
    mirror = vec4(m.x, m.y, m.z, 0.0f);
}
