// Ray against scene (3.1): every shape in turn, no acceleration structure. Included by kernels after their SWITCHes and
// their scene buffer; only the shapes that the scene has are compiled in.
//
// A shape's function returns the distance along the ray, or `far` where it is not hit nearer than that.

// Closest approach first: the rest is small near it, so nothing cancels (Haines et al., Ray Tracing Gems, 2019, ch. 7), unless
// the chord reaches near the origin or past it. There one root, `far_root`, has terms of one sign, and the other follows
// from the product of both, |f|^2 - r^2 in factors; the sign of the product says whether the ray starts inside.
float hit_sphere(uint at, vec3 o, vec3 d, float far)
{
    vec4 s = scene(at);
    precise vec3 f = o - vec3(s);
    float middle = -dot3(f, d);
    vec3 m = along(f, d, middle);
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

// The foot of p on a plane: along a long ray, p lies off it by the rounding of t.
vec3 onto_plane(vec4 plane, vec3 p)
{
    precise float above = dot3(vec3(plane), p) - plane.w;
    return along(p, vec3(plane), -above);
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

// Does the ray pass a convex polygon on the side of its vertices' images that the polygon is on? The images, along the ray,
// are one rounding of each vertex, and the comparisons of products are exact, so that of two polygons with a common edge or
// vertex at least one is hit. Returns the distance along the ray, kept between the nearest and the farthest vertex.
// After Woop, Benthin and Wald, Watertight Ray/Triangle Intersection, JCGT 2(1), 2013.
float hit_at_edge(uint vertices, uint edges, vec3 o, vec3 d, float plane_t, float far)
{
    vec3 u = from_basis(vec3(1.0f, 0.0f, 0.0f), d);
    vec3 v = from_basis(vec3(0.0f, 1.0f, 0.0f), d);
    bool left = false;
    bool right = false;
    float nearest = far;
    float farthest = 0.0f;
    float x0 = 0.0f;
    float y0 = 0.0f;
    for (uint e = 0u; e <= edges; ++e) {
        precise vec3 f = vec3(scene(vertices + (e == edges ? 0u : e))) - o;
        float x = dot3(f, u);
        float y = dot3(f, v);
        float z = dot3(f, d);
        precise float xy = x0 * y;
        precise float yx = y0 * x;
        left = left || (e > 0u && xy > yx);
        right = right || (e > 0u && xy < yx);
        nearest = z < nearest ? z : nearest;
        farthest = z > farthest ? z : farthest;
        x0 = x;
        y0 = y;
    }
    if (left == right) // outside, or seen edge on
        return far;
    float t = plane_t < nearest ? nearest : plane_t;
    t = t > farthest ? farthest : t;
    return t > 0.0f && t < far ? t : far;
}

// A convex polygon: its plane, then one half-space an edge. Edges lie outside the polygon by a hair (the margin is in
// their offsets), so that no ray slips between a polygon and what it stands on. Where rounding, larger at grazing
// incidence, leaves open whether an edge is passed inside, its end points decide.
float hit_polygon(uint at, uint edges, vec3 o, vec3 d, float far)
{
    vec4 plane = scene(at);
    float slope = dot3(vec3(plane), d);
    if (slope == 0.0f)
        return far;
    precise float t = (plane.w - dot3(vec3(plane), o)) / slope;
    bool in_reach = t > 0.0f && t < far;
    if (!in_reach && abs(slope) > 0.001f) // t may be far off at grazing incidence
        return far;
    vec3 p = along(o, d, t);
    bool open = false;
    for (uint e = 0u; e < edges; ++e) {
        vec4 edge = scene(at + 2u + e);
        float inward = dot3(vec3(edge), p);
        if (inward < edge.w) {
            precise float outside = (edge.w - inward) * abs(slope);
            if (outside > scene(at + 1u).w) // bounds the error of distances from the plane and the edges, m
                return far;
            open = true;
        }
    }
    if (open)
        return hit_at_edge(at + 2u + edges, edges, o, d, t, far);
    return in_reach ? t : far;
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
            at += 2u + 2u * edges;
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
        vec3 p = vec3(dot3(f, vec3(u)), dot3(f, vec3(v)), dot3(f, vec3(w)));
        vec3 gradient = vec3(p.x, p.y, u.w * p.z + 0.5f * v.w);
        float steepness = dot3(gradient, gradient);
        precise float value = p.x * p.x + p.y * p.y + (u.w * p.z + v.w) * p.z + w.w;
        precise vec3 n = vec3(u) * gradient.x + vec3(v) * gradient.y + vec3(w) * gradient.z;
        hit.normal = steepness > 0.0f ? normalized3(n) : vec3(w); // a cone's apex has no gradient
        // One step of Newton's back onto the surface, where the surface is flat on the step's scale.
        precise float newton = -0.5f * value / steepness;
        if (abs(value) < steepness)
            hit.position = along(hit.position, n, newton);
        hit.material = uint(scene(where + 4u).x);
    }
    if (DISKS && kind == 3u) {
        hit.position = onto_plane(scene(where), hit.position);
        hit.normal = vec3(scene(where));
        hit.material = uint(scene(where + 2u).x);
    }
    if (POLYGONS && kind == 4u) {
        hit.position = onto_plane(scene(where), hit.position);
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

// Some of the polygons and spheres, a bit each in the order of the scene; those from the 32nd on share a bit.
struct Candidates {
    uint polygons;
    uint spheres;
};

uint bit_of(uint n)
{
    return 1u << (n < 31u ? n : 31u);
}

// Shaft culling (Haines and Wallace, Shaft Culling for Efficient Ray-Traced Radiosity, 1991): what can come between a point and
// a parallelogram. Not a polygon that has both on one side, farther away than rounding; not a sphere that is farther from the
// line to the parallelogram's middle than both radii together.
Candidates shaft(vec3 from, vec3 corner, vec3 edge_u, vec3 edge_v)
{
    Candidates c;
    c.polygons = 0u;
    c.spheres = 0u;
    if (POLYGONS) {
        uint at = args.scene_layout.flat_things.z;
        for (uint n = 0u; n < args.scene_layout.flat_things.w; ++n) {
            vec3 normal = vec3(scene(at));
            vec4 tag = scene(at + 1u);
            precise float offset = scene(at).w;
            precise float here = dot3(normal, from) - offset;
            precise float there = dot3(normal, corner) - offset;
            float by_u = dot3(normal, edge_u);
            float by_v = dot3(normal, edge_v);
            precise float highest = there + (by_u > 0.0f ? by_u : 0.0f) + (by_v > 0.0f ? by_v : 0.0f);
            precise float lowest = there + (by_u < 0.0f ? by_u : 0.0f) + (by_v < 0.0f ? by_v : 0.0f);
            if (!(here > tag.w && lowest > tag.w) && !(here < -tag.w && highest < -tag.w))
                c.polygons |= bit_of(n);
            at += 2u + 2u * uint(tag.x);
        }
    }
    if (SPHERES) {
        precise vec3 line = along(along(corner, edge_u, 0.5f), edge_v, 0.5f) - from;
        float length2 = dot3(line, line);
        precise float radius = 0.5f * (sqrt(dot3(edge_u, edge_u)) + sqrt(dot3(edge_v, edge_v)));
        uint at = args.scene_layout.round_things.x;
        for (uint n = 0u; n < args.scene_layout.round_things.y; ++n) {
            vec4 s = scene(at);
            precise vec3 f = vec3(s) - from;
            precise float t = length2 > 0.0f ? dot3(f, line) / length2 : 0.0f;
            t = t > 0.0f ? t : 0.0f;
            vec3 off = along(f, line, t < 1.0f ? -t : -1.0f);
            precise float reach = (s.w + radius) * 1.00001f;
            if (!(dot3(off, off) > reach * reach))
                c.spheres |= bit_of(n);
            at += 2u;
        }
    }
    return c;
}

Candidates everything()
{
    Candidates c;
    c.polygons = 0xFFFFFFFFu;
    c.spheres = 0xFFFFFFFFu;
    return c;
}

// Does anything stand on the ray before `far`? Of polygons and spheres, the candidates are asked.
bool is_blocked(vec3 o, vec3 d, float far, Candidates c)
{
    if (POLYGONS && c.polygons != 0u) {
        uint at = args.scene_layout.flat_things.z;
        for (uint n = 0u; n < args.scene_layout.flat_things.w; ++n) {
            uint edges = uint(scene(at + 1u).x);
            if ((c.polygons & bit_of(n)) != 0u && hit_polygon(at, edges, o, d, far) < far)
                return true;
            at += 2u + 2u * edges;
        }
    }
    if (SPHERES && c.spheres != 0u) {
        uint at = args.scene_layout.round_things.x;
        for (uint n = 0u; n < args.scene_layout.round_things.y; ++n) {
            if ((c.spheres & bit_of(n)) != 0u && hit_sphere(at, o, d, far) < far)
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
    float off = clearance(p, args.scene_layout);
    return along(p, normal, dot3(normal, d) >= 0.0f ? off : -off);
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
