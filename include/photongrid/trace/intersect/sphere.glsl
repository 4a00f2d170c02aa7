// Spheres. A record: center, radius; material; 1 + number of the light whose surface it is, or 0.
SWITCH(0, SPHERES)
const uint SPHERE = 0u;

// Computes from the point of closest approach, which avoids cancellation (Haines et al., Ray Tracing Gems, 2019, ch.
// 7), unless the ray starts near the sphere or inside it. Then one root, `far_root`, is a sum of terms of equal sign,
// and the other follows from the product of the roots, |f|^2 - r^2 in factors, whose sign says whether the ray starts
// inside.
float hit_sphere(uint at, vec3 o, vec3 d, float far)
{
    vec4 s = scene(at);
    precise vec3 f = o - vec3(s);
    float middle = -dot3(f, d);
    vec3 m = ray_at(f, d, middle);
    precise float half_chord2 = s.w * s.w - dot3(m, m);
    if (!(half_chord2 >= 0.0f))
        return far;
    precise float half_chord = sqrt(half_chord2);
    precise float enter = middle - half_chord;
    if (half_chord > 0.5f * middle) {
        precise float from_middle = sqrt(dot3(f, f));
        precise float product = (from_middle - s.w) * (from_middle + s.w);
        precise float far_root = middle < 0.0f ? enter : middle + half_chord;
        precise float other_root = product / far_root;
        float leave = middle < 0.0f ? other_root : far_root;
        enter = middle < 0.0f ? far_root : other_root;
        enter = enter > 0.0f ? enter : leave;
    }
    return enter > 0.0f && enter < far ? enter : far;
}

Closest closest_sphere(vec3 o, vec3 d, Closest c)
{
    Table spheres = table_of(scene(SPHERE));
    uint at = spheres.first;
    for (uint n = 0u; n < spheres.count; ++n) {
        float t = hit_sphere(at, o, d, c.t);
        if (t < c.t) {
            c.t = t;
            c.kind = SPHERE;
            c.at = at;
        }
        at += spheres.stride;
    }
    return c;
}

Hit sphere_surface(uint at, Hit hit)
{
    vec4 s = scene(at);
    hit.normal = normalized3(hit.position - vec3(s));
    hit.position = ray_at(vec3(s), hit.normal, s.w); // onto the surface
    hit.round_share = round_share_of(scene(SCENE_SIZES), 2.0f * s.w);
    hit.material = uint(scene(at + 1u).x);
    if (scene(at + 1u).y > 0.0f) {
        hit.material = NO_MATERIAL;
        hit.light = uint(scene(at + 1u).y) - 1u;
    }
    return hit;
}

// Tests the spheres of `candidates` (shaft in trace/intersect.glsl).
bool spheres_block(vec3 o, vec3 d, float far, uint candidates)
{
    Table spheres = table_of(scene(SPHERE));
    uint at = spheres.first;
    for (uint n = 0u; n < spheres.count; ++n) {
        if ((candidates & bit_of(n)) != 0u && hit_sphere(at, o, d, far) < far)
            return true;
        at += spheres.stride;
    }
    return false;
}

// All spheres except those that are farther from the line to the parallelogram's centre than both radii together.
uint spheres_in_shaft(vec3 from, vec3 corner, vec3 edge_u, vec3 edge_v)
{
    uint candidates = 0u;
    precise vec3 line = ray_at(ray_at(corner, edge_u, 0.5f), edge_v, 0.5f) - from;
    float length2 = dot3(line, line);
    precise float radius = 0.5f * (sqrt(dot3(edge_u, edge_u)) + sqrt(dot3(edge_v, edge_v)));
    Table spheres = table_of(scene(SPHERE));
    uint at = spheres.first;
    for (uint n = 0u; n < spheres.count; ++n) {
        vec4 s = scene(at);
        precise vec3 f = vec3(s) - from;
        precise float t = length2 > 0.0f ? dot3(f, line) / length2 : 0.0f;
        t = t > 0.0f ? t : 0.0f;
        vec3 off = ray_at(f, line, t < 1.0f ? -t : -1.0f);
        precise float both = (s.w + radius) * 1.00001f;
        if (!(dot3(off, off) > both * both))
            candidates |= bit_of(n);
        at += spheres.stride;
    }
    return candidates;
}
