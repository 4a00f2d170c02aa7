#include "scene.hpp"

#include <limits>

namespace host {

namespace {
    constexpr double least_distance = 1e-6; // m; nearer hits are on the surface that the ray starts on
    constexpr double index_of_refraction = 1.5;

    /// The first intersection of a ray with each shape beyond least_distance; empty if there is none.
    std::optional<double> distance_to(const sphere& s, const ray& r)
    {
        const vec3 to_middle = s.middle - r.origin;
        const double closest = dot(to_middle, r.direction);
        const vec3 off = to_middle - closest * r.direction;
        const double inside = s.radius * s.radius - dot(off, off);
        if (!(inside > 0))
            return {};
        const double half = std::sqrt(inside);
        for (const double t : {closest - half, closest + half})
            if (t > least_distance)
                return t;
        return {};
    }
    std::optional<double> distance_to(const rectangle& q, const ray& r)
    {
        const vec3 normal = cross(q.a, q.b);
        const double t = dot(q.corner - r.origin, normal) / dot(r.direction, normal);
        const vec3 p = r.origin + t * r.direction - q.corner;
        const double u = dot(p, q.a) / dot(q.a, q.a), v = dot(p, q.b) / dot(q.b, q.b);
        if (t > least_distance && u >= 0 && u <= 1 && v >= 0 && v <= 1)
            return t;
        return {};
    }
    std::optional<double> distance_to(const tube& c, const ray& r)
    {
        const vec3 from = r.origin - c.foot;
        const double a = r.direction.x * r.direction.x + r.direction.z * r.direction.z,
                     b = from.x * r.direction.x + from.z * r.direction.z;
        const double inside = b * b - a * (from.x * from.x + from.z * from.z - c.radius * c.radius);
        if (!(inside > 0) || !(a > 0))
            return {};
        const double half = std::sqrt(inside);
        for (const double t : {(-b - half) / a, (-b + half) / a})
            if (const double y = from.y + t * r.direction.y; t > least_distance && y >= 0 && y <= c.height)
                return t;
        return {};
    }

    vec3 normal_at(const sphere& s, vec3 p) { return (1 / s.radius) * (p - s.middle); }
    vec3 normal_at(const rectangle& q, vec3) { return q.normal(); }
    vec3 normal_at(const tube& c, vec3 p) { return (1 / c.radius) * vec3{p.x - c.foot.x, 0, p.z - c.foot.z}; }

    /// Reflectance of glass, unpolarized, by the cosines and indices on both sides (Fresnel).
    double fresnel(double cos_in, double cos_out, double index_in, double index_out)
    {
        const double s = (index_in * cos_in - index_out * cos_out) / (index_in * cos_in + index_out * cos_out);
        const double p = (index_in * cos_out - index_out * cos_in) / (index_in * cos_out + index_out * cos_in);
        return (s * s + p * p) / 2;
    }
} // namespace

std::optional<hit> scene::nearest(const ray& r) const
{
    std::optional<hit> best;
    const auto try_shape = [&](const auto& shape) {
        const auto t = distance_to(shape, r);
        if (!t || (best && best->distance <= *t))
            return;
        const vec3 position = r.origin + *t * r.direction, normal = normal_at(shape, position);
        const bool outside = dot(normal, r.direction) < 0;
        best = {*t, position, outside ? normal : -normal, outside, shape.of};
    };
    for (const auto& s : spheres)
        try_shape(s);
    for (const auto& q : rectangles)
        try_shape(q);
    for (const auto& c : tubes)
        try_shape(c);
    try_shape(lamp);
    return best;
}

bool scene::sees(vec3 from, vec3 to) const
{
    const double distance = length(to - from);
    const ray r{from, (1 / distance) * (to - from)};
    const auto blocks = [&](const auto& shape) {
        const auto t = distance_to(shape, r);
        return t && *t < distance - least_distance;
    };
    for (const auto& s : spheres)
        if (blocks(s))
            return false;
    for (const auto& q : rectangles)
        if (blocks(q))
            return false;
    for (const auto& c : tubes)
        if (blocks(c))
            return false;
    return true;
}

ray specular_bounce(const ray& r, const hit& h, random_stream& random)
{
    const double cos_in = -dot(r.direction, h.normal);
    const ray reflected{h.position, normalized(r.direction + 2 * cos_in * h.normal)};
    if (h.of.kind == surface::mirror)
        return reflected;
    const double index_in = h.outside ? 1 : index_of_refraction, index_out = h.outside ? index_of_refraction : 1;
    const double ratio = index_in / index_out, cos_out2 = 1 - ratio * ratio * (1 - cos_in * cos_in);
    if (cos_out2 <= 0) // total reflection
        return reflected;
    const double cos_out = std::sqrt(cos_out2);
    if (random.next() < fresnel(cos_in, cos_out, index_in, index_out))
        return reflected;
    return {h.position, normalized(ratio * r.direction + (ratio * cos_in - cos_out) * h.normal)};
}

scene box_scene()
{
    const material white{surface::diffuse, {0.74, 0.74, 0.74}}, red{surface::diffuse, {0.47, 0.05, 0.05}},
        green{surface::diffuse, {0.09, 0.40, 0.08}};
    const material glass{surface::glass, {1, 1, 1}}, gold{surface::mirror, {0.98, 0.78, 0.36}},
        light{surface::lamp, {150, 135, 115}};
    scene s;
    s.spheres = {{{0.42, 0.38, 0.15}, 0.38, glass}};
    s.tubes = {{{-0.45, 0, 0.35}, 0.38, 0.12, gold}};
    s.rectangles = {
        {{-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, white}, // floor
        {{-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, white}, // ceiling
        {{-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, white}, // back
        {{-1, 0, -1}, {0, 2, 0}, {0, 0, 2}, red},   // left
        {{1, 0, -1}, {0, 0, 2}, {0, 2, 0}, green},  // right
    };
    s.lamp = {{-0.1, 1.2, -0.9}, {0.2, 0, 0}, {0, 0.14, 0.14}, light};
    return s;
}

} // namespace host
