// Ray against scene for the reference renderer: double precision, every shape from its own equation, no acceleration
// structure. Nothing is shared with kernels/scene_hit.glsl.
//
// A ray knows the shape it starts on. A plane is then not asked again, and of a round shape's two roots the one at the
// start is known to be 0, which leaves the other one exactly; so no ray needs to start off its surface.
#pragma once

#include <photongrid/scene.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <span>

/// The parts of the reference renderer (docs/reference.md): double precision, m, W.
namespace photongrid::reference {

constexpr std::uint32_t nothing = 0xFFFFFFFFu;                       ///< no shape, no material, no light
constexpr double infinity = std::numeric_limits<double>::infinity(); ///< the distance of what is not met

/// Where a ray begins and where it goes.
struct ray {
    dvec3 origin{0};              ///< m
    dvec3 direction{0, 0, 1};     ///< unit
    std::uint32_t from = nothing; ///< the shape on which the origin lies
};

/// What a ray meets first.
struct hit {
    double t = infinity;              ///< along the ray, m; infinity: nothing is met
    std::uint32_t shape = nothing;    ///< number in `geometry`
    std::uint32_t material = nothing; ///< index into scene::materials; `nothing` for a light's surface
    std::uint32_t light = nothing;    ///< index into geometry::lights()
    dvec3 position{0};                ///< moved onto the surface
    dvec3 normal{0, 0, 1};            ///< unit; outward, or as the shape was given
};

/// A unit vector at right angles to n.
inline dvec3 across(const dvec3& n)
{
    const dvec3 a = glm::abs(n);
    const dvec3 least = a.x <= a.y && a.x <= a.z ? dvec3(1, 0, 0) : a.y <= a.z ? dvec3(0, 1, 0) : dvec3(0, 0, 1);
    return glm::normalize(glm::cross(n, least));
}

/// The real roots of a t^2 + 2 b t + c = 0; infinity for one that is not there. `starts_on`: c is 0 but for rounding,
/// and the root that is then 0 is left out.
inline std::array<double, 2> real_roots(double a, double b, double c, bool starts_on)
{
    const auto kept = [](double root) { return std::isfinite(root) ? root : infinity; };
    if (starts_on)
        return {kept(-2 * b / a), infinity};
    const double discriminant = b * b - a * c;
    if (!(discriminant >= 0))
        return {infinity, infinity};
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    return {kept(q / a), kept(c / q)};
}

/// A surface of revolution about an axis from z = 0 at `base` to z = height.
struct turned_shape {
    /// How the radius changes along the axis.
    enum class profile { cylinder, cone, paraboloid } kind = profile::cylinder; ///< which of them it is
    dvec3 base{0};                                                              ///< m; where z is 0
    dvec3 axis{0, 0, 1};                                                        ///< unit
    double height = 1;                                                          ///< m
    double radius = 1; ///< m; of a cone at z = 0, of a paraboloid at z = height

    /// Along the axis from `from` to `to`, m; they differ.
    turned_shape(profile k, const dvec3& from, const dvec3& to, double r)
        : kind(k), base(from), axis(glm::normalize(to - from)), height(glm::length(to - from)), radius(r)
    {
    }

    /// Distance from the axis at height z, both in m.
    double radius_at(double z) const
    {
        switch (kind) {
        case profile::cylinder: return radius;
        case profile::cone: return radius * (1 - z / height);
        default: return radius * std::sqrt(std::max(0.0, z / height));
        }
    }

    /// As geometry::nearest measures it, m; infinity where r misses. `starts_on`: r begins on this shape.
    double distance(const ray& r, bool starts_on) const
    {
        // Seen from the point of the ray nearest the middle, so that squares of long distances do not cancel.
        const double ahead = starts_on ? 0 : -glm::dot(r.origin - (base + 0.5 * height * axis), r.direction);
        const dvec3 f = r.origin + ahead * r.direction - base;
        const double z = glm::dot(f, axis), dz = glm::dot(r.direction, axis);
        const dvec3 p = f - z * axis, d = r.direction - dz * axis;
        // |p + t d|^2 = radius_at(z + t dz)^2 in powers of t.
        double a = glm::dot(d, d), b = glm::dot(p, d), c = glm::dot(p, p);
        if (kind == profile::cylinder) {
            c -= radius * radius;
        } else if (kind == profile::cone) {
            const double slope = radius / height, here = slope * (height - z);
            a -= slope * slope * dz * dz;
            b += slope * dz * here;
            c -= here * here;
        } else {
            const double opening = radius * radius / height;
            b -= 0.5 * opening * dz;
            c -= opening * z;
        }
        double nearest = infinity;
        for (const double t : real_roots(a, b, c, starts_on)) {
            const double height_there = z + t * dz;
            if (t + ahead > 0 && t + ahead < nearest && height_there >= 0 && height_there <= height)
                nearest = t + ahead;
        }
        return nearest;
    }

    /// Moves p onto the surface; returns the outward normal there (the axis at a cone's apex).
    dvec3 settle(dvec3& p) const
    {
        const double z = std::clamp(glm::dot(p - base, axis), 0.0, height);
        const dvec3 off = (p - base) - glm::dot(p - base, axis) * axis;
        const double r = glm::length(off);
        const dvec3 outward = r > 0 ? off / r : across(axis);
        p = base + z * axis + radius_at(z) * outward;
        switch (kind) {
        case profile::cylinder: return outward;
        case profile::cone: return r > 0 ? glm::normalize(height * outward + radius * axis) : axis;
        default:
            return glm::normalize(
                2 * height * radius_at(z) * outward - radius * radius * axis); // gradient of height rho^2 - radius^2 z
        }
    }
};

/// A convex polygon and its edges; also a rectangle light's surface.
struct flat_shape {
    dvec3 normal{0, 0, 1}; ///< unit, by the order of the vertices
    dvec3 corner{0};       ///< m; the first vertex
    /// A half plane: points p with dot(inward, p - corner) at least `offset` are inside.
    struct edge {
        dvec3 inward;  ///< unit, in the plane
        double offset; ///< m
    };
    std::vector<edge> edges; ///< without those of length 0

    /// Of a polygon that check() accepts.
    explicit flat_shape(const polygon& p) : normal(glm::normalize(area_vector(p))), corner(p.vertices[0])
    {
        double extent = 0;
        for (const auto& v : p.vertices)
            extent = std::max(extent, glm::length(v - corner));
        for (std::size_t i = 0; i < p.vertices.size(); ++i) {
            const dvec3 a = p.vertices[i], b = p.vertices[(i + 1) % p.vertices.size()];
            const dvec3 inward = glm::cross(normal, b - a);
            if (const double length = glm::length(inward);
                length > 0) // rounding must not open a gap between neighbours
                edges.push_back({inward / length, glm::dot(inward / length, a - corner) - 1e-13 * extent});
        }
    }

    /// As turned_shape::distance.
    double distance(const ray& r, bool starts_on) const
    {
        if (starts_on)
            return infinity;
        const double t = glm::dot(normal, corner - r.origin) / glm::dot(normal, r.direction);
        if (!(t > 0) || !(t < infinity))
            return infinity;
        const dvec3 p = r.origin + t * r.direction - corner;
        for (const auto& e : edges)
            if (glm::dot(e.inward, p) < e.offset)
                return infinity;
        return t;
    }
    /// Moves p onto the plane; returns the normal.
    dvec3 settle(dvec3& p) const
    {
        p -= glm::dot(p - corner, normal) * normal;
        return normal;
    }
};

/// A sphere.
struct ball_shape {
    dvec3 center{0};   ///< m
    double radius = 1; ///< m

    /// As turned_shape::distance.
    double distance(const ray& r, bool starts_on) const
    {
        const dvec3 f = r.origin - center;
        const double b = glm::dot(f, r.direction);
        if (starts_on)
            return -2 * b > 0 ? -2 * b : infinity;
        const dvec3 nearest = f - b * r.direction; // of the whole line to the centre
        const double half2 = radius * radius - glm::dot(nearest, nearest);
        if (!(half2 >= 0))
            return infinity;
        const double half = std::sqrt(half2);
        return -b - half > 0 ? -b - half : -b + half > 0 ? -b + half : infinity;
    }
    /// Moves p onto the sphere; returns the outward normal there.
    dvec3 settle(dvec3& p) const
    {
        const dvec3 n = glm::normalize(p - center);
        p = center + radius * n;
        return n;
    }
};

/// A disk.
struct disk_shape {
    dvec3 center{0};       ///< m
    dvec3 normal{0, 0, 1}; ///< unit
    double radius = 1;     ///< m

    /// As turned_shape::distance.
    double distance(const ray& r, bool starts_on) const
    {
        if (starts_on)
            return infinity;
        const double t = glm::dot(normal, center - r.origin) / glm::dot(normal, r.direction);
        if (!(t > 0) || !(t < infinity))
            return infinity;
        const dvec3 p = r.origin + t * r.direction - center;
        return glm::dot(p, p) <= radius * radius ? t : infinity;
    }
    /// Moves p onto the plane; returns the normal.
    dvec3 settle(dvec3& p) const
    {
        p -= glm::dot(p - center, normal) * normal;
        return normal;
    }
};

/// A light, ready to be sampled. Lights are chosen in proportion to their power, rgb together.
struct light_source {
    bool is_area = false;          ///< a rectangle, else a point
    dvec3 corner{0};               ///< m; a point light's position
    dvec3 edge_u{0};               ///< m
    dvec3 edge_v{0};               ///< m
    dvec3 normal{0};               ///< unit; a rectangle sends light out on this side
    dvec3 power{0};                ///< W, rgb
    double area = 0;               ///< m^2
    double probability = 0;        ///< of being chosen; those of all lights add up to 1
    std::uint32_t shape = nothing; ///< a rectangle's own surface, as geometry numbers it

    /// Radiance of an area light's front, W/(m^2 sr).
    dvec3 radiance() const { return power / (M_PI * area); }
};

/// The scene's shapes, numbered: spheres, cylinders, cones, paraboloids, disks, polygons, rectangle lights.
class geometry {
public:
    /// Of a scene that check() accepts; it is copied.
    explicit geometry(const scene& s)
    {
        for (const auto& x : s.spheres)
            add(balls_, {x.center, x.radius}, x.material);
        for (const auto& x : s.cylinders)
            add(turned_, {turned_shape::profile::cylinder, x.base, x.top, x.radius}, x.material);
        for (const auto& x : s.cones)
            add(turned_, {turned_shape::profile::cone, x.base, x.apex, x.radius}, x.material);
        for (const auto& x : s.paraboloids)
            add(turned_, {turned_shape::profile::paraboloid, x.vertex, x.rim, x.radius}, x.material);
        for (const auto& x : s.disks)
            add(disks_, {x.center, glm::normalize(x.normal), x.radius}, x.material);
        for (const auto& x : s.polygons)
            add(flats_, flat_shape(x), x.material);
        first_light_ = static_cast<std::uint32_t>(materials_.size());
        double total = 0;
        for (const auto& l : s.rectangle_lights) {
            light_source source{
                .is_area = true, .corner = l.corner, .edge_u = l.edge_u, .edge_v = l.edge_v, .power = l.power};
            const dvec3 area = glm::cross(l.edge_u, l.edge_v);
            source.area = glm::length(area);
            source.normal = area / source.area;
            source.shape = static_cast<std::uint32_t>(materials_.size());
            add(flats_,
                flat_shape({{l.corner, l.corner + l.edge_u, l.corner + l.edge_u + l.edge_v, l.corner + l.edge_v}, 0}),
                nothing);
            lights_.push_back(source);
        }
        for (const auto& l : s.point_lights)
            lights_.push_back({.corner = l.position, .power = l.power});
        for (const auto& l : lights_)
            total += l.power.x + l.power.y + l.power.z;
        for (auto& l : lights_)
            l.probability = (l.power.x + l.power.y + l.power.z) / total;
    }

    /// What r meets first; its shape is `nothing` where there is none.
    hit nearest(const ray& r) const
    {
        hit h;
        each([&](const auto& shape, std::uint32_t number) {
            if (const double t = shape.distance(r, number == r.from); t < h.t) {
                h.t = t;
                h.shape = number;
            }
            return true;
        });
        if (h.shape == nothing)
            return h;
        h.position = r.origin + h.t * r.direction;
        with(h.shape, [&](const auto& shape) { h.normal = shape.settle(h.position); });
        if (!detail::finite(h.position) || !detail::finite(h.normal))
            return {}; // a shape too small to be told from a point at its distance from the origin
        h.material = materials_[h.shape];
        h.light = h.shape >= first_light_ ? h.shape - first_light_ : nothing;
        return h;
    }

    /// Does anything but shape `target` stand on the ray before `far`, m?
    bool blocked(const ray& r, double far, std::uint32_t target) const
    {
        bool found = false;
        each([&](const auto& shape, std::uint32_t number) {
            found = number != target && shape.distance(r, number == r.from) < far;
            return !found;
        });
        return found;
    }

    /// Rectangles first, then points, each in the scene's order.
    std::span<const light_source> lights() const { return lights_; }

private:
    template <class Shape>
    void add(std::vector<Shape>& to, Shape shape, std::uint32_t material)
    {
        to.push_back(std::move(shape));
        materials_.push_back(material);
    }
    /// visit(shape, number) for each shape until it returns false.
    template <class Visit>
    void each(Visit visit) const
    {
        std::uint32_t number = 0;
        const auto all = [&](const auto& shapes) {
            for (const auto& s : shapes)
                if (!visit(s, number++))
                    return false;
            return true;
        };
        all(balls_) && all(turned_) && all(disks_) && all(flats_);
    }
    template <class Visit>
    void with(std::size_t number, Visit visit) const
    {
        const auto in = [&](const auto& shapes) {
            if (number < shapes.size()) {
                visit(shapes[number]);
                return true;
            }
            number -= shapes.size();
            return false;
        };
        in(balls_) || in(turned_) || in(disks_) || in(flats_);
    }

    std::vector<ball_shape> balls_;
    std::vector<turned_shape> turned_;
    std::vector<disk_shape> disks_;
    std::vector<flat_shape> flats_;
    std::vector<std::uint32_t> materials_; ///< of every shape
    std::uint32_t first_light_ = 0;
    std::vector<light_source> lights_; ///< rectangles first, as their shapes are numbered
};

} // namespace photongrid::reference
