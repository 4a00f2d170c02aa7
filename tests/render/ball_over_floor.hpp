// A scene whose caustic is known.
#pragma once

#include <photongrid/scene/scene.hpp>

#include <cmath>
#include <glm/glm.hpp>

namespace photongrid::testing {

/// A point light above a glass ball above a nearly black floor, all on one axis.
struct ball_over_floor {
    double index = 1.5, radius = 0.3, height = 0.4, light_height = 1.6, light_power = 10; ///< lengths in m, power in W

    scene as_scene() const
    {
        const double floor_half = 3;
        scene s;
        s.name = "caustic";
        s.materials
            = {{"floor", material_kind::lambertian, dvec3(0.001)}, {"glass", material_kind::glass, dvec3(1), index}};
        s.polygons = {{{{-floor_half, 0, -floor_half}, {-floor_half, 0, floor_half}, {floor_half, 0, floor_half},
                           {floor_half, 0, -floor_half}},
            0}};
        s.spheres = {{{0, height, 0}, radius, 1}};
        s.point_lights = {{"bulb", {0, light_height, 0}, dvec3(light_power)}};
        s.camera = {{0, 1, -3}, {0, 0, 0}, {0, 1, 0}, 45};
        s.render = {.map = {.photons = 20000, .grid = {100, 1, 100}},
            .estimate = {.k = 50, .max_radius = 0.1},
            .output = {.width = 8, .height = 8}};
        return s;
    }

    /// Power that two refractions bring to the floor at most `within` m off the axis: a one-dimensional integral over
    /// the angle at the light.
    double power_on_floor(double within) const
    {
        const auto fresnel = [](double cos_i, double eta) {
            const double sin2 = eta * eta * (1 - cos_i * cos_i);
            if (sin2 >= 1)
                return 1.0;
            const double cos_t = std::sqrt(1 - sin2);
            const double a = (cos_i - eta * cos_t) / (cos_i + eta * cos_t),
                         p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
            return 0.5 * (a * a + p * p);
        };
        double power = 0;
        const int steps = 200000;
        const double largest = std::asin(radius / (light_height - height));
        for (int i = 0; i < steps; ++i) {
            const double theta = (i + 0.5) / steps * largest;
            glm::dvec2 o(0, light_height - height),
                d(std::sin(theta), -std::cos(theta)); // about the ball's middle, in the plane
            const double bb = glm::dot(o, d), disc = bb * bb - glm::dot(o, o) + radius * radius;
            const glm::dvec2 p = o + d * (-bb - std::sqrt(std::max(0.0, disc)));
            const glm::dvec2 n = p / radius;
            const double cos_i = -glm::dot(d, n), eta = 1 / index,
                         cos_t = std::sqrt(1 - eta * eta * (1 - cos_i * cos_i));
            const glm::dvec2 in = eta * d + (eta * cos_i - cos_t) * n;
            const glm::dvec2 q = p - 2 * glm::dot(p, in) * in;
            const glm::dvec2 m = -q / radius; // inward normal
            const double cos_j = -glm::dot(in, m),
                         cos_u = std::sqrt(std::max(0.0, 1 - index * index * (1 - cos_j * cos_j)));
            const glm::dvec2 out = index * in + (index * cos_j - cos_u) * m;
            const double t = (-height - q.y) / out.y;
            if (out.y < 0 && std::abs(q.x + t * out.x) <= within)
                power += light_power * (1 - fresnel(cos_i, eta)) * (1 - fresnel(cos_j, index)) * 0.5 * std::sin(theta)
                    * largest / steps;
        }
        return power;
    }
};

} // namespace photongrid::testing
