// Where an eye ray ended on a rough surface (eye_bounce.glsl). Included by kernels after their INPUTs scene, points,
// directions, throughputs, surfaces and emissions, and after trace/scatter.glsl.

bool ended_on_rough(uint ray)
{
    return points(ray).w <= -2.0f;
}

// The surface as the eye ray met it.
Surface rough_end(uint ray)
{
    vec4 way = directions(ray);
    vec4 facing = surfaces(ray);
    vec3 outward = vec3(way.w, throughputs(ray).w, emissions(ray).w);
    Surface s;
    s.number = uint(facing.w);
    s.material = material_of(s.number);
    precise float alpha = -2.0f - points(ray).w;
    s.material.alpha = alpha;
    s.way = BY_REFLECTION;
    s.d = vec3(way);
    s.outside = !(dot3(outward, s.d) > 0.0f);
    s.geometric = s.outside ? outward : -outward;
    s.shading = vec3(facing);
    return s;
}
