// Spheres that are lights (scene/sphere_light.hpp). Included by kernels after trace/lights.glsl and the SWITCH
// SPHERE_LIGHTS. Records: at + 1: centre; w: radiance divided by the power; at + 2: radius.

// The distance of rays' ends from the surface, m.
float sphere_light_offset(vec3 centre, float radius, float round_share)
{
    return ray_offset(abs(centre) + vec3(radius, radius, radius), round_share);
}
