// Where an eye ray ended on a rough surface (eye_bounce.glsl). Included by kernels after their INPUTs scene, points,
// directions, throughputs, surfaces and emissions, and after core/natural_exp.glsl and trace/scatter.glsl.
SWITCH(16, TEXTURES)
#include <photongrid/trace/media.glsl>
#include <photongrid/trace/end_code.glsl>

bool ended_on_rough(uint ray)
{
    return points(ray).w <= -2.0f;
}

// The surface as the eye ray met it.
Crossing crossing_at(uint ray, Surface s)
{
    return crossing(inside_of(emissions(ray).w), s.number, s.outside, material_of(s.number).index_of_refraction);
}

Surface rough_end(uint ray)
{
    vec4 way = directions(ray);
    vec4 facing = surfaces(ray);
    float y = throughputs(ray).w;
    float last = emissions(ray).w;
    vec3 outward = vec3(way.w, y, z_at_end(way.w, y, last));
    Surface s;
    s.number = uint(facing.w);
    s.material = material_of(s.number);
    precise float alpha = -2.0f - points(ray).w;
    s.material.alpha = alpha;
    if (keeps_color())
        s.material.reflectance = color_at_end(last);
    s.way = BY_REFLECTION;
    s.d = vec3(way);
    s.outside = !(dot3(outward, s.d) > 0.0f);
    s.geometric = s.outside ? outward : -outward;
    s.shading = vec3(facing);
    if (MEDIA)
        s.material = between_media(s.material, crossing_at(ray, s));
    return s;
}
