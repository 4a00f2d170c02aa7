// Where things stand in the scene buffer (include/photongrid/device_scene.hpp writes it).
#ifndef PHOTONGRID_SHARED_IS_READ // kernels/begin.hpp

struct Scene {
    uvec4 round_things; // first sphere, how many; first quadric, how many
    uvec4 flat_things;  // first disk, how many; first polygon, how many
    uvec4 rest;         // first material; first light, how many; unused
    vec4 scale;         // x: share of the round shapes in `clearance`, m
};

// Materials' kinds.
const uint LAMBERTIAN_SURFACE = 0u;
const uint MIRROR_SURFACE = 1u; // metals too
const uint GLASS_SURFACE = 2u;

struct Hit {
    float t;        // along the ray; negative: nothing hit
    uint material;  // 0xFFFFFFFF: a light's surface
    uint light;     // which light, if so
    vec3 position;
    vec3 normal;    // geometric, unit, outward or as the shape was given
};

struct Fresnel {
    float reflected; // share of the light that is reflected, 1 for total internal reflection
    vec3 refracted;  // direction of the rest
};

// How far off a surface a ray starts, so that the surface is behind it: a bound on what rounding makes of the distance
// between them. 32 units in the last place of the coordinates' sum, and of the size of the scene's largest round shape.
inline float clearance(vec3 p, Scene s)
{
    precise float bound = (abs(p.x) + abs(p.y) + abs(p.z)) * 1.9073486328125e-6f + s.scale.x;
    return bound;
}

#endif
