// The tests of a ray against a box and against a triangle.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

struct Ray {
    vec3 origin;
    vec3 direction;
    vec3 inverse; // of the components of its direction, at most 10^30
    // Shear along the ray: with these as axes, the ray is the third axis, and a point's third coordinate is its
    // distance along the ray, in lengths of the direction.
    vec3 across_x;
    vec3 across_y;
    vec3 along;
};

inline float bounded_inverse(float d)
{
    float least = d < 0.0f ? -1.0e-30f : 1.0e-30f;
    float x = abs(d) < 1.0e-30f ? least : d;
    precise float inverse = 1.0f / x;
    return inverse;
}

// The shear is along the direction's largest component, after Woop, Benthin and Wald, Watertight Ray/Triangle
// Intersection, JCGT 2(1), 2013.
inline Ray ray_of(vec3 o, vec3 d)
{
    Ray r;
    r.origin = o;
    r.direction = d;
    r.inverse = vec3(bounded_inverse(d.x), bounded_inverse(d.y), bounded_inverse(d.z));
    float x = abs(d.x);
    float y = abs(d.y);
    float z = abs(d.z);
    if (x >= y && x >= z) {
        precise vec3 s = vec3(1.0f / d.x, -d.y / d.x, -d.z / d.x);
        r.across_x = vec3(s.y, 1.0f, 0.0f);
        r.across_y = vec3(s.z, 0.0f, 1.0f);
        r.along = vec3(s.x, 0.0f, 0.0f);
    } else if (y >= z) {
        precise vec3 s = vec3(-d.x / d.y, 1.0f / d.y, -d.z / d.y);
        r.across_x = vec3(1.0f, s.x, 0.0f);
        r.across_y = vec3(0.0f, s.z, 1.0f);
        r.along = vec3(0.0f, s.y, 0.0f);
    } else {
        precise vec3 s = vec3(-d.x / d.z, -d.y / d.z, 1.0f / d.z);
        r.across_x = vec3(1.0f, 0.0f, s.x);
        r.across_y = vec3(0.0f, 1.0f, s.y);
        r.along = vec3(0.0f, 0.0f, s.z);
    }
    return r;
}

// Where the line of a ray is inside a box. x: it enters, y: it leaves, in lengths of the direction; x > y: it passes
// by. The box is enlarged by 2^-20 of its farthest coordinate from the origin, four times the rounding error of the
// test of a triangle, so the boxes of a closed surface leave no gap that the triangles do not leave. A box inside
// another is never entered before it, nor left after it: each step here is monotone.
inline vec2 inside_box(vec3 low, vec3 high, Ray r)
{
    precise vec3 from = low - r.origin;
    precise vec3 to = high - r.origin;
    vec3 far = vec3(max(abs(from.x), abs(to.x)), max(abs(from.y), abs(to.y)), max(abs(from.z), abs(to.z)));
    precise float more = max(far.x, max(far.y, far.z)) * 9.5367432e-7f; // 2^-20
    precise vec3 first = vec3((r.inverse.x < 0.0f ? to.x + more : from.x - more) * r.inverse.x,
        (r.inverse.y < 0.0f ? to.y + more : from.y - more) * r.inverse.y,
        (r.inverse.z < 0.0f ? to.z + more : from.z - more) * r.inverse.z);
    precise vec3 last = vec3((r.inverse.x < 0.0f ? from.x - more : to.x + more) * r.inverse.x,
        (r.inverse.y < 0.0f ? from.y - more : to.y + more) * r.inverse.y,
        (r.inverse.z < 0.0f ? from.z - more : to.z + more) * r.inverse.z);
    return vec2(max(first.x, max(first.y, first.z)), min(last.x, min(last.y, last.z)));
}

// Whether a ray of length `far` is somewhere inside a box.
inline bool meets_box(vec2 inside, float far)
{
    return inside.x <= inside.y && inside.x <= far && inside.y >= 0.0f;
}

// A point's coordinate on one of the axes of a sheared ray.
inline float on_axis(vec3 p, vec3 axis)
{
    precise float x = p.x * axis.x + p.y * axis.y + p.z * axis.z;
    return x;
}

inline float least_of(vec3 v)
{
    return min(v.x, min(v.y, v.z));
}
inline float most_of(vec3 v)
{
    return max(v.x, max(v.y, v.z));
}
inline vec3 lowest_of(vec3 a, vec3 b)
{
    return vec3(min(a.x, b.x), min(a.y, b.y), min(a.z, b.z));
}
inline vec3 highest_of(vec3 a, vec3 b)
{
    return vec3(max(a.x, b.x), max(a.y, b.y), max(a.z, b.z));
}

// The distance along the ray at which it hits the triangle with corners a, b and c from either side, in lengths of its
// direction; not above 0: it does not.
//
// The corners are sheared along the ray, which then is the third axis, each by itself, so that triangles share what
// they share. Comparing rounded products never takes a point on one side of an edge for one on the other, only for one
// on the edge. A triangle that is seen edge-on is a line, which is hit where the ray is inside its box. After Woop,
// Benthin and Wald, Watertight Ray/Triangle Intersection, JCGT 2(1), 2013.
//
// The distance is clamped to the corners' and to where the ray is inside the triangle's box (inside_box). So a hit
// lies inside every box around the triangle as inside_box() finds it, and no tree of boxes loses it.
inline float hit_triangle(vec3 a, vec3 b, vec3 c, Ray r)
{
    precise vec3 from_a = a - r.origin;
    precise vec3 from_b = b - r.origin;
    precise vec3 from_c = c - r.origin;
    vec3 x = vec3(on_axis(from_a, r.across_x), on_axis(from_b, r.across_x), on_axis(from_c, r.across_x));
    vec3 y = vec3(on_axis(from_a, r.across_y), on_axis(from_b, r.across_y), on_axis(from_c, r.across_y));
    precise vec3 forth = vec3(x.y * y.z, x.z * y.x, x.x * y.y);
    precise vec3 back = vec3(x.z * y.y, x.x * y.z, x.y * y.x);
    bool left = forth.x > back.x || forth.y > back.y || forth.z > back.z;
    bool right = forth.x < back.x || forth.y < back.y || forth.z < back.z;
    if (left && right)
        return 0.0f;
    if (!left && !right
        && !(least_of(x) <= 0.0f && most_of(x) >= 0.0f && least_of(y) <= 0.0f && most_of(y) >= 0.0f))
        return 0.0f;
    vec3 z = vec3(on_axis(from_a, r.along), on_axis(from_b, r.along), on_axis(from_c, r.along));
    float nearest = least_of(z);
    float farthest = most_of(z);
    precise vec3 share = forth - back;
    precise float all = share.x + share.y + share.z;
    precise float t = (share.x * z.x + share.y * z.y + share.z * z.z) / all;
    t = t > nearest ? t : nearest; // also for NaN: seen edge-on
    t = t < farthest ? t : farthest;
    vec2 inside = inside_box(lowest_of(a, lowest_of(b, c)), highest_of(a, highest_of(b, c)), r);
    if (!(inside.x <= inside.y))
        return 0.0f;
    t = t > inside.x ? t : inside.x;
    t = t < inside.y ? t : inside.y;
    return t;
}

// Whether p is surely on the inner side of a triangle's edge; `n`: the triangle's normal; `off`: how far rounding may
// have moved p along each axis.
inline bool is_inside_edge(vec3 p, vec3 from, vec3 to, vec3 n, vec3 off)
{
    precise vec3 edge = to - from;
    precise vec3 way = p - from;
    precise vec3 inward
        = vec3(n.y * edge.z - n.z * edge.y, n.z * edge.x - n.x * edge.z, n.x * edge.y - n.y * edge.x);
    vec3 m = abs(n);
    vec3 e = abs(edge);
    precise vec3 terms = vec3(m.y * e.z + m.z * e.y, m.z * e.x + m.x * e.z, m.x * e.y + m.y * e.x);
    float share = 4.7683716e-7f; // 8 units of 2^-24, of which `inward` has 4
    precise vec3 rounding = abs(way) * share + off;
    return on_axis(inward, way) > on_axis(terms, rounding);
}

// Whether a hit by hit_triangle() is none, since the triangle is behind the ray: the ray surely starts on one side of
// the triangle's plane and leads away from it, and its line surely passes through the triangle. So rays that leave a
// surface do not hit it again, however large it is beside their distance from it. Where rounding leaves an edge open,
// the hit stays, because the triangle beyond that edge may have been left out for it.
//
// The bounds are, in units of 2^-24: of the height above the plane 4, and 5 happen, of which one is the plane's; of the
// ray's slope the same.
inline bool is_behind(vec4 plane, vec3 a, vec3 b, vec3 c, Ray r)
{
    vec3 n = vec3(plane);
    precise float height = on_axis(n, r.origin) - plane.w;
    precise float least_height = (on_axis(abs(n), abs(r.origin)) + abs(plane.w)) * 2.3841858e-7f; // 2^-22
    float slope = on_axis(n, r.direction);
    precise float least_slope = on_axis(abs(n), abs(r.direction)) * 2.3841858e-7f;
    if (!(height > least_height && slope > least_slope) && !(height < -least_height && slope < -least_slope))
        return false;
    precise vec3 p = r.origin - r.direction * (height / slope); // in the plane
    float share = 1.1920929e-7f; // 2^-23
    precise vec3 off = abs(r.direction) * (least_height / abs(slope)) + abs(p) * share;
    return is_inside_edge(p, a, b, n, off) && is_inside_edge(p, b, c, n, off) && is_inside_edge(p, c, a, n, off);
}

#endif
