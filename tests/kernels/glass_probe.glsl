// Light meets a surface of glass, for tests.
#include "vector.glsl"
#include "scene_layout.glsl"

struct Params {
    Scene scene_layout;
};
PARAMS(Params)
SWITCH(0, SPHERES)
SWITCH(1, QUADRICS)
SWITCH(2, DISKS)
SWITCH(3, POLYGONS)
SWITCH(7, AREA_LIGHTS)
INPUT(0, vec4, scene)
INPUT(1, vec4, directions)
INPUT(2, vec4, normals)    // xyz: outward; w: index of refraction
OUTPUT(0, vec4, refracted) // xyz: direction; w: reflected share
OUTPUT(1, vec4, mirror)    // xyz: direction

#include "scene_hit.glsl"

void kernel(uint i)
{
    vec4 normal = normals(i);
    Fresnel f = dielectric(vec3(directions(i)), vec3(normal), normal.w);
    refracted = vec4(f.refracted.x, f.refracted.y, f.refracted.z, f.reflected);
    vec3 m = mirrored(vec3(directions(i)), vec3(normal));
    mirror = vec4(m.x, m.y, m.z, 0.0f);
}
