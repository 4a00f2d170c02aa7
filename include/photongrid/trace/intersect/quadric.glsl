// Quadrics about an axis: x^2 + y^2 + A z^2 + B z + C = 0 for 0 <= z <= height in their own frame: cylinders, cones and
// paraboloids (scene/quadric.hpp). Records: base, height; u, A; v, B; w, C, with the frame's axes u, v, w; material.
SWITCH(1, QUADRICS)
const uint QUADRIC = 1u;

float hit_quadric(uint at, vec3 o, vec3 d, float far)
{
    vec4 base = scene(at);
    vec4 u = scene(at + 1u);
    vec4 v = scene(at + 2u);
    vec4 w = scene(at + 3u);
    float height = base.w;
    vec3 f = o - vec3(base);
    vec3 p = vec3(dot3(f, vec3(u)), dot3(f, vec3(v)), dot3(f, vec3(w)));
    vec3 q = vec3(dot3(d, vec3(u)), dot3(d, vec3(v)), dot3(d, vec3(w)));
    // Start from the point of the ray that is closest to the shape's centre.
    float shift = -dot3(vec3(p.x, p.y, p.z - 0.5f * height), q);
    p = ray_at(p, q, shift);
    precise float a = q.x * q.x + q.y * q.y + u.w * q.z * q.z;
    precise float b = p.x * q.x + p.y * q.y + u.w * p.z * q.z + 0.5f * v.w * q.z;
    precise float c = p.x * p.x + p.y * p.y + u.w * p.z * p.z + v.w * p.z + w.w;
    precise float disc = b * b - a * c;
    if (!(disc >= 0.0f))
        return far;
    precise float root = sqrt(disc);
    precise float k = b > 0.0f ? -(b + root) : root - b;
    // The two solutions, k / a and c / k, each if it exists. A ray parallel to the asymptote has only the second.
    float nearest = far;
    if (abs(a) > 1e-12f) {
        float t0 = k / a;
        precise float z0 = p.z + q.z * t0;
        t0 += shift;
        if (t0 > 0.0f && t0 < nearest && z0 >= 0.0f && z0 <= height)
            nearest = t0;
    }
    if (abs(k) > 0.0f) {
        float t1 = c / k;
        precise float z1 = p.z + q.z * t1;
        t1 += shift;
        if (t1 > 0.0f && t1 < nearest && z1 >= 0.0f && z1 <= height)
            nearest = t1;
    }
    return nearest;
}

Closest closest_quadric(vec3 o, vec3 d, Closest c)
{
    Table quadrics = table_of(scene(QUADRIC));
    uint at = quadrics.first;
    for (uint n = 0u; n < quadrics.count; ++n) {
        float t = hit_quadric(at, o, d, c.t);
        if (t < c.t) {
            c.t = t;
            c.kind = QUADRIC;
            c.at = at;
        }
        at += quadrics.stride;
    }
    return c;
}

Hit quadric_surface(uint at, Hit hit)
{
    vec4 base = scene(at);
    vec4 u = scene(at + 1u);
    vec4 v = scene(at + 2u);
    vec4 w = scene(at + 3u);
    vec3 f = hit.position - vec3(base);
    vec3 p = vec3(dot3(f, vec3(u)), dot3(f, vec3(v)), dot3(f, vec3(w)));
    vec3 gradient = vec3(p.x, p.y, u.w * p.z + 0.5f * v.w);
    float steepness = dot3(gradient, gradient);
    precise float value = p.x * p.x + p.y * p.y + (u.w * p.z + v.w) * p.z + w.w;
    precise vec3 n = vec3(u) * gradient.x + vec3(v) * gradient.y + vec3(w) * gradient.z;
    hit.normal = steepness > 0.0f ? normalized3(n) : vec3(w); // a cone's apex has no gradient
    // One Newton step onto the surface, if the surface is nearly flat at the scale of the step.
    precise float newton = -0.5f * value / steepness;
    if (abs(value) < steepness)
        hit.position = ray_at(hit.position, n, newton);
    precise float size = 2.0f * (abs(p.x) + abs(p.y) + base.w);
    hit.round_share = round_share_of(scene(SCENE_SIZES), size);
    hit.material = uint(scene(at + 4u).x);
    return hit;
}

bool quadrics_block(vec3 o, vec3 d, float far)
{
    Table quadrics = table_of(scene(QUADRIC));
    uint at = quadrics.first;
    for (uint n = 0u; n < quadrics.count; ++n) {
        if (hit_quadric(at, o, d, far) < far)
            return true;
        at += quadrics.stride;
    }
    return false;
}
