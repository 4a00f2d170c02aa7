// Lights for the reference renderer: how a point sees them, and the rays that leave them.
#pragma once

#include <photongrid/reference/directions.hpp>
#include <photongrid/reference/environment.hpp>
#include <photongrid/reference/triangles.hpp>

#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// What a light is.
enum class light_form { point, rectangle, sphere, mesh, spot, directional, environment };

/// A light, prepared for sampling. Lights are chosen with probabilities proportional to their power (sum of rgb).
struct light_source {
    light_form form = light_form::point;
    dvec3 position{0};       ///< m; a rectangle's corner, a sphere's centre
    dvec3 edge_u{0};         ///< m; of a rectangle
    dvec3 edge_v{0};         ///< m
    dvec3 normal{0};         ///< unit; a rectangle emits on this side; a spotlight's axis; distant light's direction
    double radius = 0;       ///< m; of a sphere; of distant light: of the scene about `position`
    double inner_cosine = 1; ///< of a spotlight
    double outer_cosine = 1; ///< of a spotlight
    dvec3 power{0};          ///< W, rgb
    dvec3 brightest{0};      ///< W/sr, of a point or a spotlight; W/m^2, of directional light
    double area = 0;         ///< m^2
    double probability = 0;  ///< probability of being chosen
    std::uint32_t shape = nothing; ///< its surface's number in geometry; of a mesh its first triangle's
    std::vector<double> areas{};   ///< of a mesh's triangles, each added to those before it, m^2
    std::optional<environment> sky{};

    /// Whether it has a surface.
    bool is_area() const
    {
        return form == light_form::rectangle || form == light_form::sphere || form == light_form::mesh;
    }
    /// Whether rays can find it.
    bool is_visible() const { return is_area() || form == light_form::environment; }
    /// The radiance of an area light's outside, W/(m^2 sr).
    dvec3 radiance() const { return power / (std::numbers::pi * area); }
    /// Of a spotlight: the share of its greatest intensity at an angle to the axis.
    double falloff(double cosine) const
    {
        if (cosine >= inner_cosine)
            return 1;
        const double t = (cosine - outer_cosine) / (inner_cosine - outer_cosine);
        return t > 0 ? t * t * (3 - 2 * t) : 0;
    }
};

/// A point of a light.
struct light_point {
    dvec3 position{0};             ///< m
    dvec3 normal{0};               ///< unit; it emits on this side; 0 of a point light
    std::uint32_t shape = nothing; ///< the number of its surface in geometry
};

/// A light as a point sees it, by one sample.
struct light_view {
    dvec3 towards{0};              ///< unit
    double distance = 0;           ///< m
    dvec3 arriving{0};             ///< radiance, W/(m^2 sr); where density is 0: irradiance, facing the light, W/m^2
    double density = 0;            ///< of the direction, per sr; 0 if no other direction leads to the light
    std::uint32_t shape = nothing; ///< of the light
};

/// A ray that leaves a light, and its power, W.
struct emitted_ray {
    ray from;
    dvec3 power{0};
};

/// Prepared lights. `first_triangle`: the number in geometry of the first triangle.
class light_sampler {
public:
    light_sampler(const triangle_set& triangles, std::uint32_t first_triangle)
        : triangles_(triangles), first_triangle_(first_triangle)
    {
    }

    /// A point of a light that has one, evenly over its area.
    template <class Random>
    light_point point_of(const light_source& l, Random& random) const
    {
        switch (l.form) {
        case light_form::rectangle: {
            const double u = random(), v = random();
            return {l.position + u * l.edge_u + v * l.edge_v, l.normal, l.shape};
        }
        case light_form::sphere: {
            const double u = random(), v = random();
            const dvec3 n = uniform_direction(u, v);
            return {l.position + l.radius * n, n, l.shape};
        }
        case light_form::mesh: {
            const double goal = random() * l.areas.back();
            const auto found = std::min(std::upper_bound(l.areas.begin(), l.areas.end(), goal) - l.areas.begin(),
                static_cast<std::ptrdiff_t>(l.areas.size()) - 1);
            const std::uint32_t shape = l.shape + static_cast<std::uint32_t>(found), triangle = shape - first_triangle_;
            const double u = random(), v = random();
            return {triangles_.point(triangle, u, v), triangles_.normal(triangle), shape};
        }
        default: return {l.position, dvec3(0), nothing};
        }
    }

    /// A light as it is seen from p.
    template <class Random>
    light_view seen_from(const light_source& l, const dvec3& p, Random& random) const
    {
        if (l.form == light_form::environment) {
            const auto s = l.sky->draw(random);
            return {s.towards, infinity, s.radiance, s.density};
        }
        if (l.form == light_form::directional)
            return {-l.normal, infinity, l.brightest};
        const auto target = point_of(l, random);
        const dvec3 towards = target.position - p;
        const double distance = glm::length(towards);
        if (!(distance > 0))
            return {};
        const dvec3 d = towards / distance;
        if (!l.is_area()) {
            const double share = l.form == light_form::spot ? l.falloff(-glm::dot(d, l.normal)) : 1;
            return {d, distance, share * l.brightest / (distance * distance)};
        }
        const double leaving = -glm::dot(target.normal, d);
        if (!(leaving > 0))
            return {};
        return {d, distance, l.radiance(), distance * distance / (l.area * leaving), target.shape};
    }

    /// A ray with the light's power. Distant light comes from a disc that covers the scene.
    template <class Random>
    emitted_ray emit(const light_source& l, Random& random) const
    {
        const double u = random(), v = random();
        if (l.form == light_form::directional || l.form == light_form::environment) {
            dvec3 d = l.normal, flux = l.brightest;
            if (l.form == light_form::environment) {
                const auto s = l.sky->draw(random);
                d = -s.towards;
                flux = s.radiance / s.density;
            }
            const dvec3 outward = around(d, 0, 2 * std::numbers::pi * v);
            return {{l.position + l.radius * (std::sqrt(u) * outward - d), d, nothing},
                flux * (std::numbers::pi * l.radius * l.radius)};
        }
        const auto start = point_of(l, random);
        if (l.is_area())
            return {{start.position, cosine_direction(start.normal, u, v), start.shape}, l.power};
        if (l.form == light_form::point)
            return {{start.position, uniform_direction(u, v), nothing}, l.power};
        // Evenly over the cone; the power has the falloff.
        const double cosine = 1 - u * (1 - l.outer_cosine), cone = 2 * std::numbers::pi * (1 - l.outer_cosine); // sr
        return {{start.position, around(l.normal, cosine, 2 * std::numbers::pi * v), nothing},
            l.brightest * (l.falloff(cosine) * cone)};
    }

private:
    const triangle_set& triangles_;
    std::uint32_t first_triangle_;
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
