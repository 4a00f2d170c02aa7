// Ray-scene intersection for the reference renderer: tests every shape, without an acceleration structure but for the
// triangles of meshes.
#pragma once

#include <photongrid/reference/shapes.hpp>
#include <photongrid/reference/triangles.hpp>

#include <numbers>
#include <span>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid::reference {

/// A light, prepared for sampling. Lights are chosen with probabilities proportional to their power (sum of rgb).
struct light_source {
    bool is_area = false;          ///< a rectangle or a mesh, else a point
    dvec3 corner{0};               ///< m; a point light's position
    dvec3 edge_u{0};               ///< m
    dvec3 edge_v{0};               ///< m
    dvec3 normal{0};               ///< unit; a rectangle emits on this side
    dvec3 power{0};                ///< W, rgb
    double area = 0;               ///< m^2
    double probability = 0;        ///< probability of being chosen
    std::uint32_t shape = nothing; ///< its surface's number in geometry; of a mesh its first triangle's
    std::vector<double> areas{};   ///< of a mesh's triangles, each added to those before it, m^2

    /// The radiance of an area light's front, W/(m^2 sr).
    dvec3 radiance() const { return power / (std::numbers::pi * area); }
};

/// A point of a light.
struct light_point {
    dvec3 position{0};     ///< m
    dvec3 normal{0};       ///< unit; it emits on this side; 0 of a point light
    std::uint32_t shape{}; ///< the number of its surface in geometry, or `nothing`
};

/// The shapes of a scene, numbered in the order of shape_lists(), followed by the surfaces of rectangle lights and the
/// triangles of meshes.
class geometry {
public:
    /// The scene must pass check(). It is copied.
    explicit geometry(const scene& s) : triangles_(s)
    {
        for_each_shape(s, [&](const auto& list, auto) {
            for (const auto& x : list)
                add(shape_of(x), x.material);
        });
        first_light_ = static_cast<std::uint32_t>(materials_.size());
        first_triangle_ = first_light_ + static_cast<std::uint32_t>(s.rectangle_lights.size());
        double total = 0;
        for_each_light(s, [&](const auto& list, auto) {
            for (const auto& l : list)
                add(l);
        });
        for (const auto& l : lights_)
            total += l.power.x + l.power.y + l.power.z;
        for (auto& l : lights_)
            l.probability = (l.power.x + l.power.y + l.power.z) / total;
    }

    /// The number of the first mesh's first triangle.
    std::uint32_t first_triangle() const { return first_triangle_; }

    /// The closest hit of r; its shape is `nothing` for a miss.
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
        triangles_.each_hit(r, triangle_from(r), h.t, [&](std::uint32_t triangle, double t) {
            h.t = t;
            h.shape = first_triangle_ + triangle;
            return t;
        });
        if (h.shape == nothing)
            return h;
        h.position = r.origin + h.t * r.direction;
        if (h.shape >= first_triangle_) {
            h.normal = triangles_.settle(h.shape - first_triangle_, h.position);
            h.shading = triangles_.shading(h.shape - first_triangle_, h.position, h.normal);
            h.material = triangles_.material(h.shape - first_triangle_);
            if (h.shape - first_triangle_ < lights_of_triangles_.size())
                h.light = lights_of_triangles_[h.shape - first_triangle_];
            return h;
        }
        with(h.shape, [&](const auto& shape) { h.normal = shape.settle(h.position); });
        h.shading = h.normal;
        if (!detail::finite(h.position) || !detail::finite(h.normal))
            return {}; // the shape is too small for double precision at this distance from the origin
        h.material = materials_[h.shape];
        h.light = h.shape >= first_light_ ? h.shape - first_light_ : nothing;
        return h;
    }

    /// Whether any shape except `target` occludes the ray before `far`, m.
    bool blocked(const ray& r, double far, std::uint32_t target) const
    {
        bool found = false;
        each([&](const auto& shape, std::uint32_t number) {
            found = number != target && shape.distance(r, number == r.from) < far;
            return !found;
        });
        if (!found)
            triangles_.each_hit(r, triangle_from(r), far, [&](std::uint32_t, double) {
                found = true;
                return 0.0;
            });
        return found;
    }

    /// A point of a light, evenly over its area; `random()` gives numbers from 0 to 1.
    template <class Random>
    light_point point_of(const light_source& l, Random& random) const
    {
        if (l.areas.empty() && l.is_area) {
            const double u = random(), v = random();
            return {l.corner + u * l.edge_u + v * l.edge_v, l.normal, l.shape};
        }
        if (l.areas.empty())
            return {l.corner, dvec3(0), nothing};
        const double goal = random() * l.areas.back();
        const auto found = std::min(std::upper_bound(l.areas.begin(), l.areas.end(), goal) - l.areas.begin(),
            static_cast<std::ptrdiff_t>(l.areas.size()) - 1);
        const std::uint32_t shape = l.shape + static_cast<std::uint32_t>(found), triangle = shape - first_triangle_;
        const double u = random(), v = random();
        return {triangles_.point(triangle, u, v), triangles_.normal(triangle), shape};
    }

    /// Rectangle lights, point lights, then mesh lights, each in the scene's order.
    std::span<const light_source> lights() const { return lights_; }

private:
    template <class Shape>
    void add(Shape shape, std::uint32_t material)
    {
        std::get<std::vector<Shape>>(shapes_).push_back(std::move(shape));
        materials_.push_back(material);
    }
    void add(const rectangle_light& l)
    {
        light_source source{
            .is_area = true, .corner = l.corner, .edge_u = l.edge_u, .edge_v = l.edge_v, .power = l.power};
        const dvec3 area = glm::cross(l.edge_u, l.edge_v);
        source.area = glm::length(area);
        source.normal = area / source.area;
        source.shape = static_cast<std::uint32_t>(materials_.size());
        add(shape_of(surface_of(l)), nothing);
        lights_.push_back(source);
    }
    void add(const point_light& l) { lights_.push_back({.corner = l.position, .power = l.power}); }
    void add(const mesh_light& l)
    {
        light_source source{.is_area = true, .power = l.power};
        const auto first = static_cast<std::uint32_t>(lights_of_triangles_.size());
        for (std::uint32_t t = 0; t < l.surface.surface->triangles.size(); ++t) {
            source.area += triangles_.area(first + t);
            source.areas.push_back(source.area);
            lights_of_triangles_.push_back(static_cast<std::uint32_t>(lights_.size()));
        }
        source.shape = first_triangle_ + first;
        lights_.push_back(std::move(source));
    }
    /// The triangle that the ray starts on, or none.
    std::uint32_t triangle_from(const ray& r) const
    {
        return r.from != nothing && r.from >= first_triangle_ ? r.from - first_triangle_ : nothing;
    }
    /// Calls visit(shape, number) for each shape until it returns false.
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
        std::apply([&](const auto&... shapes) { (all(shapes) && ...); }, shapes_);
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
        std::apply([&](const auto&... shapes) { (in(shapes) || ...); }, shapes_);
    }

    shape_vectors shapes_;
    triangle_set triangles_;
    std::uint32_t first_triangle_ = 0;
    std::vector<std::uint32_t> lights_of_triangles_; ///< those of mesh lights come first
    std::vector<std::uint32_t> materials_;           ///< per shape, but for triangles
    std::uint32_t first_light_ = 0;
    std::vector<light_source> lights_; ///< rectangles first, in the order of their shapes
};

} // namespace photongrid::reference

#include <photongrid/backend/exact_end.hpp>
