// Ray against scene (3.1): every shape in turn, no acceleration structure. Included by kernels after their SWITCHes and
// their scene buffer; only the shapes that the scene has are compiled in.
//
// A shape's function returns the distance along the ray, or `far` where it is not hit nearer than that.

// Closest approach first: the rest is small near it, so nothing cancels (Haines et al., Ray Tracing Gems, 2019, ch. 7).
float hit_sphere(uint at, vec3 o, vec3 d, float far)
{
    vec4 s = scene(at);
    precise vec3 f = o - vec3(s);
    float middle = -dot3(f, d);
    vec3 m = along(f, d, middle);
    precise float distance2 = s.w * s.w - dot3(m, m);
    if (!(distance2 >= 0.0f))
        return far;
    precise float half_chord = sqrt(distance2);
    precise float t0 = middle - half_chord;
    precise float t1 = middle + half_chord;
    float t = t0 > 0.0f ? t0 : t1;
    return t > 0.0f && t < far ? t : far;
}

// x^2 + y^2 + A z^2 + B z + C = 0 for 0 <= z <= height in a frame of its own: cylinder, cone, paraboloid.
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
    // Start from the closest approach to the shape's middle.
    float shift = -dot3(vec3(p.x, p.y, p.z - 0.5f * height), q);
    p = along(p, q, shift);
    precise float a = q.x * q.x + q.y * q.y + u.w * q.z * q.z;
    precise float b = p.x * q.x + p.y * q.y + u.w * p.z * q.z + 0.5f * v.w * q.z;
    precise float c = p.x * p.x + p.y * p.y + u.w * p.z * p.z + v.w * p.z + w.w;
    precise float disc = b * b - a * c;
    if (!(disc >= 0.0f))
        return far;
    precise float root = sqrt(disc);
    precise float k = b > 0.0f ? -(b + root) : root - b;
    // The two solutions; a ray along the surface's asymptote has only the second.
    float t0 = far;
    float t1 = far;
    if (abs(a) > 1e-12f)
        t0 = k / a;
    if (abs(k) > 0.0f)
        t1 = c / k;
    precise float z0 = p.z + q.z * t0;
    precise float z1 = p.z + q.z * t1;
    t0 += shift;
    t1 += shift;
    float nearest = far;
    if (t0 > 0.0f && t0 < nearest && z0 >= 0.0f && z0 <= height)
        nearest = t0;
    if (t1 > 0.0f && t1 < nearest && z1 >= 0.0f && z1 <= height)
        nearest = t1;
    return nearest;
}

// Distance to a plane, or `far`.
float hit_plane(vec4 plane, vec3 o, vec3 d, float far)
{
    float slope = dot3(vec3(plane), d);
    if (slope == 0.0f)
        return far;
    precise float t = (plane.w - dot3(vec3(plane), o)) / slope;
    return t > 0.0f && t < far ? t : far;
}

float hit_disk(uint at, vec3 o, vec3 d, float far)
{
    float t = hit_plane(scene(at), o, d, far);
    if (!(t < far))
        return far;
    vec4 center = scene(at + 1u);
    precise vec3 f = along(o, d, t) - vec3(center);
    return dot3(f, f) <= center.w * center.w ? t : far;
}

// A convex polygon: its plane, then one half-space an edge. Edges lie outside the polygon by a hair (the margin is in
// their offsets), so that no ray slips between two polygons that share one.
float hit_polygon(uint at, uint edges, vec3 o, vec3 d, float far)
{
    float t = hit_plane(scene(at), o, d, far);
    if (!(t < far))
        return far;
    vec3 p = along(o, d, t);
    for (uint e = 0u; e < edges; ++e) {
        vec4 edge = scene(at + 2u + e);
        if (dot3(vec3(edge), p) < edge.w)
            return far;
    }
    return t;
}

// The nearest hit, without its normal: t, and through `shape_at` and `shape_kind` which shape.
Hit nearest_hit(vec3 o, vec3 d)
{
    Hit hit;
    float t = 3.0e38f;
    uint kind = 0u;
    uint where = 0u;
    if (SPHERES) {
        uint at = args.scene_layout.round_things.x;
        for (uint n = 0u; n < args.scene_layout.round_things.y; ++n) {
            float s = hit_sphere(at, o, d, t);
            if (s < t) {
                t = s;
                kind = 1u;
                where = at;
            }
            at += 2u;
        }
    }
    if (QUADRICS) {
        uint at = args.scene_layout.round_things.z;
        for (uint n = 0u; n < args.scene_layout.round_things.w; ++n) {
            float s = hit_quadric(at, o, d, t);
            if (s < t) {
                t = s;
                kind = 2u;
                where = at;
            }
            at += 5u;
        }
    }
    if (DISKS) {
        uint at = args.scene_layout.flat_things.x;
        for (uint n = 0u; n < args.scene_layout.flat_things.y; ++n) {
            float s = hit_disk(at, o, d, t);
            if (s < t) {
                t = s;
                kind = 3u;
                where = at;
            }
            at += 3u;
        }
    }
    if (POLYGONS) {
        uint at = args.scene_layout.flat_things.z;
        for (uint n = 0u; n < args.scene_layout.flat_things.w; ++n) {
            uint edges = uint(scene(at + 1u).x);
            float s = hit_polygon(at, edges, o, d, t);
            if (s < t) {
                t = s;
                kind = 4u;
                where = at;
            }
            at += 2u + edges;
        }
    }

    hit.t = kind == 0u ? -1.0f : t;
    hit.material = 0u;
    hit.light = 0u;
    hit.position = along(o, d, t);
    hit.normal = vec3(0.0f, 0.0f, 1.0f);
    if (SPHERES && kind == 1u) {
        vec4 s = scene(where);
        hit.normal = normalized3(hit.position - vec3(s));
        hit.position = along(vec3(s), hit.normal, s.w); // back onto the surface
        hit.material = uint(scene(where + 1u).x);
    }
    if (QUADRICS && kind == 2u) {
        vec4 base = scene(where);
        vec4 u = scene(where + 1u);
        vec4 v = scene(where + 2u);
        vec4 w = scene(where + 3u);
        vec3 f = hit.position - vec3(base);
        vec3 gradient = vec3(dot3(f, vec3(u)), dot3(f, vec3(v)), u.w * dot3(f, vec3(w)) + 0.5f * v.w);
        precise vec3 n = vec3(u) * gradient.x + vec3(v) * gradient.y + vec3(w) * gradient.z;
        hit.normal = dot3(n, n) > 0.0f ? normalized3(n) : vec3(w); // a cone's apex has no gradient
        hit.material = uint(scene(where + 4u).x);
    }
    if (DISKS && kind == 3u) {
        hit.normal = vec3(scene(where));
        hit.material = uint(scene(where + 2u).x);
    }
    if (POLYGONS && kind == 4u) {
        hit.normal = vec3(scene(where));
        vec4 tag = scene(where + 1u);
        hit.material = uint(tag.y);
        if (AREA_LIGHTS && tag.z > 0.0f) {
            hit.material = 0xFFFFFFFFu;
            hit.light = uint(tag.z) - 1u;
        }
    }
    return hit;
}

// Does anything stand on the ray before `far`?
bool is_blocked(vec3 o, vec3 d, float far)
{
    if (POLYGONS) {
        uint at = args.scene_layout.flat_things.z;
        for (uint n = 0u; n < args.scene_layout.flat_things.w; ++n) {
            uint edges = uint(scene(at + 1u).x);
            if (hit_polygon(at, edges, o, d, far) < far)
                return true;
            at += 2u + edges;
        }
    }
    if (SPHERES) {
        uint at = args.scene_layout.round_things.x;
        for (uint n = 0u; n < args.scene_layout.round_things.y; ++n) {
            if (hit_sphere(at, o, d, far) < far)
                return true;
            at += 2u;
        }
    }
    if (QUADRICS) {
        uint at = args.scene_layout.round_things.z;
        for (uint n = 0u; n < args.scene_layout.round_things.w; ++n) {
            if (hit_quadric(at, o, d, far) < far)
                return true;
            at += 5u;
        }
    }
    if (DISKS) {
        uint at = args.scene_layout.flat_things.x;
        for (uint n = 0u; n < args.scene_layout.flat_things.y; ++n) {
            if (hit_disk(at, o, d, far) < far)
                return true;
            at += 3u;
        }
    }
    return false;
}

// Where a ray that leaves the surface at p in direction d starts: off the surface, on the side it goes to.
vec3 ray_start(vec3 p, vec3 normal, vec3 d)
{
    return along(p, normal, dot3(normal, d) >= 0.0f ? args.scene_layout.scale.x : -args.scene_layout.scale.x);
}

vec3 mirrored(vec3 d, vec3 normal)
{
    return along(d, normal, -2.0f * dot3(d, normal));
}

// Light of direction d meets a dielectric with this outward normal and index of refraction.
Fresnel dielectric(vec3 d, vec3 normal, float index)
{
    Fresnel f;
    f.reflected = 1.0f;
    f.refracted = d;
    float incoming = -dot3(d, normal);
    bool entering = incoming > 0.0f;
    float eta = entering ? 1.0f / index : index; // ratio of indices, this side over the other
    float cos_i = entering ? incoming : -incoming;
    cos_i = cos_i < 1.0f ? cos_i : 1.0f;
    precise float sin2_t = eta * eta * (1.0f - cos_i * cos_i);
    if (sin2_t >= 1.0f)
        return f; // total internal reflection
    precise float cos_t = sqrt(1.0f - sin2_t);
    precise float parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    precise float perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    precise float reflected = 0.5f * (parallel * parallel + perpendicular * perpendicular);
    f.reflected = reflected;
    vec3 facing = entering ? normal : -normal;
    precise vec3 r = d * eta + facing * (eta * cos_i - cos_t);
    f.refracted = normalized3(r);
    return f;
}
