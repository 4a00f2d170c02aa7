// Ray-scene intersection for the reference renderer: tests every shape, without an acceleration structure but for the
// triangles of meshes.
#pragma once

#include <photongrid/reference/light_sources.hpp>
#include <photongrid/reference/shapes.hpp>

#include <numbers>
#include <span>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// The shapes of a scene, numbered in the order of shape_lists(), followed by the surfaces of rectangle and sphere
/// lights and the triangles of meshes.
class geometry {
public:
    /// The scene must pass check(). It is copied, but for its materials, which must outlive the geometry.
    explicit geometry(const scene& s) : triangles_(s)
    {
        for_each_shape(s, [&](const auto& list, auto) {
            for (const auto& x : list)
                add(shape_of(x), x.material);
        });
        first_light_ = static_cast<std::uint32_t>(materials_.size());
        first_triangle_ = first_light_ + static_cast<std::uint32_t>(s.rectangle_lights.size() + s.sphere_lights.size());
        const bounds all = bounds_of(s);
        middle_ = 0.5 * (all.low + all.high);
        radius_ = 0.5 * glm::length(all.high - all.low);
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
            const auto attributes = triangles_.attributes_at(h.shape - first_triangle_, h.position);
            h.color = attributes.color;
            h.coordinates = attributes.coordinates;
            if (h.shape - first_triangle_ < lights_of_triangles_.size())
                h.light = lights_of_triangles_[h.shape - first_triangle_];
            return h;
        }
        with(h.shape, [&](const auto& shape) { h.normal = shape.settle(h.position); });
        h.shading = h.normal;
        if (!detail::finite(h.position) || !detail::finite(h.normal))
            return {}; // the shape is too small for double precision at this distance from the origin
        h.material = materials_[h.shape];
        h.light = h.shape >= first_light_ ? lights_of_shapes_[h.shape - first_light_] : nothing;
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
            triangles_.each_hit(r, triangle_from(r), far, [&](std::uint32_t triangle, double) {
                if (first_triangle_ + triangle == target) // rounding may put it nearer than `far`
                    return far;
                found = true;
                return 0.0;
            });
        return found;
    }

    /// How a point sees a light, by one sample; `random()` gives numbers from 0 to 1.
    template <class Random>
    light_view seen_from(const light_source& l, const dvec3& point, Random& random) const
    {
        return light_sampler(triangles_, first_triangle_).seen_from(l, point, random);
    }
    /// A ray that leaves a light.
    template <class Random>
    emitted_ray emit(const light_source& l, Random& random) const
    {
        return light_sampler(triangles_, first_triangle_).emit(l, random);
    }
    /// The light that surrounds the scene, or null.
    const light_source* sky() const { return !lights_.empty() && lights_.back().sky ? &lights_.back() : nullptr; }

    /// In the order of light_lists().
    std::span<const light_source> lights() const { return lights_; }

private:
    template <class Shape>
    void add(Shape shape, std::uint32_t material)
    {
        std::get<std::vector<Shape>>(shapes_).push_back(std::move(shape));
        materials_.push_back(material);
    }
    /// The surface of a light, which was added last, belongs to the light that is added next. Returns its number.
    std::uint32_t surface_of_next_light()
    {
        const auto number = first_light_ + static_cast<std::uint32_t>(lights_of_shapes_.size());
        lights_of_shapes_.push_back(static_cast<std::uint32_t>(lights_.size()));
        return number;
    }
    void add(const rectangle_light& l)
    {
        light_source source{.form = light_form::rectangle,
            .position = l.corner,
            .edge_u = l.edge_u,
            .edge_v = l.edge_v,
            .power = l.power};
        const dvec3 area = glm::cross(l.edge_u, l.edge_v);
        source.area = glm::length(area);
        source.normal = area / source.area;
        add(shape_of(surface_of(l)), nothing);
        source.shape = surface_of_next_light();
        lights_.push_back(source);
    }
    void add(const point_light& l)
    {
        lights_.push_back({.position = l.position, .power = l.power, .brightest = l.power / (4 * std::numbers::pi)});
    }
    void add(const sphere_light& l)
    {
        light_spheres_.push_back(shape_of(surface_of(l)));
        materials_.push_back(nothing);
        const std::uint32_t shape = surface_of_next_light();
        lights_.push_back({.form = light_form::sphere,
            .position = l.center,
            .radius = l.radius,
            .power = l.power,
            .area = 4 * std::numbers::pi * l.radius * l.radius,
            .shape = shape});
    }
    void add(const mesh_light& l)
    {
        light_source source{.form = light_form::mesh, .power = l.power};
        const auto first = static_cast<std::uint32_t>(lights_of_triangles_.size());
        for (std::uint32_t t = 0; t < l.surface.surface->triangles.size(); ++t) {
            source.area += triangles_.area(first + t);
            source.areas.push_back(source.area);
            lights_of_triangles_.push_back(static_cast<std::uint32_t>(lights_.size()));
        }
        source.shape = first_triangle_ + first;
        lights_.push_back(std::move(source));
    }
    void add(const spot_light& l)
    {
        const double inner = std::cos(glm::radians(l.inner_angle)), outer = std::cos(glm::radians(l.outer_angle));
        // The power of an intensity of 1: that of the whole cone, less half of the part that fades.
        const double of_one = std::numbers::pi * ((1 - inner) + (1 - outer));
        lights_.push_back({.form = light_form::spot,
            .position = l.position,
            .normal = glm::normalize(l.direction),
            .inner_cosine = inner,
            .outer_cosine = outer,
            .power = l.power,
            .brightest = l.power / of_one});
    }
    void add(const directional_light& l)
    {
        lights_.push_back({.form = light_form::directional,
            .position = middle_,
            .normal = glm::normalize(l.direction),
            .radius = radius_,
            .power = l.irradiance * (std::numbers::pi * radius_ * radius_),
            .brightest = l.irradiance});
    }
    void add(const environment_light& l)
    {
        light_source source{.form = light_form::environment, .position = middle_, .radius = radius_};
        source.sky.emplace(l);
        source.power = source.sky->irradiance_everywhere() * (std::numbers::pi * radius_ * radius_);
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
        if (std::apply([&](const auto&... shapes) { return (all(shapes) && ...); }, shapes_))
            all(light_spheres_);
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
        if (!std::apply([&](const auto&... shapes) { return (in(shapes) || ...); }, shapes_))
            in(light_spheres_);
    }

    shape_vectors shapes_;
    std::vector<decltype(shape_of(sphere{}))> light_spheres_; ///< after all shapes_
    triangle_set triangles_;
    std::uint32_t first_triangle_ = 0;
    std::vector<std::uint32_t> lights_of_shapes_;    ///< of the surfaces of rectangle and sphere lights
    std::vector<std::uint32_t> lights_of_triangles_; ///< those of mesh lights come first
    std::vector<std::uint32_t> materials_;           ///< per shape, but for triangles
    std::uint32_t first_light_ = 0;
    std::vector<light_source> lights_;
    dvec3 middle_{0};   ///< of the scene, m
    double radius_ = 0; ///< of a sphere about it that holds the scene, m
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
