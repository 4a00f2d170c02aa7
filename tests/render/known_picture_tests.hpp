// Scenes whose light is known: a closed sphere, a lamp without obstacles, a glass ball.
#pragma once

#include "pictures.hpp"

namespace photongrid::testing {

TYPED_TEST_P(pictures, a_closed_diffuse_sphere_has_the_known_radiance)
{
    const dvec3 reflectance(0.5, 0.25, 0.75);
    const auto s = integrating_sphere(reflectance);
    for (const auto builder : {map_builder::sort, map_builder::route}) {
        auto settings = s.render;
        settings.map.builder = builder;
        settings.map.slots = 8;
        render_stats stats;
        const auto im = this->picture(s, settings, &stats);
        glm::dvec3 mean(0);
        for (const auto& p : im.pixels)
            mean += glm::dvec3(p) / static_cast<double>(im.pixels.size());
        for (int c = 0; c < 3; ++c) {
            const double known = reflectance[c] / (1 - reflectance[c]);
            EXPECT_NEAR(mean[c], known, 0.02 * known)
                << "channel " << c; // noise of 40,000 photons, the paper's N/A bias
        }
        expect_an_exact_account(stats.photons, settings.map.photons);
        EXPECT_EQ(stats.photons.escaped, 0u); // closed: no ray slips out
    }
}

TYPED_TEST_P(pictures, direct_light_of_a_rectangle_equals_the_form_factor)
{
    // Lambert's formula for the irradiance of a diffuse polygon, in double.
    auto s = small_cornell();
    s.spheres.clear();
    const auto& lamp = s.rectangle_lights[0];
    const dvec3 corners[4]
        = {lamp.corner, lamp.corner + lamp.edge_u, lamp.corner + lamp.edge_u + lamp.edge_v, lamp.corner + lamp.edge_v};
    const double area = glm::length(glm::cross(lamp.edge_u, lamp.edge_v));
    struct place {
        dvec3 point, normal;
    };
    const place places[] = {{{0.5, 0, 0.5}, {0, 1, 0}}, {{0.1, 0, 0.9}, {0, 1, 0}}, {{0.0, 0.3, 0.5}, {1, 0, 0}},
        {{1.0, 0.8, 0.2}, {-1, 0, 0}}, {{0.5, 0.1, 1.0}, {0, 0, -1}}};

    auto& b = this->b();
    const auto device = upload_scene(b, s);
    auto settings = s.render;
    settings.view.light_samples = 1024;
    std::vector<glm::vec4> points, normals;
    for (const auto& p : places) {
        points.emplace_back(glm::vec3(p.point - device.layout.center), 1.0f);
        normals.emplace_back(glm::vec3(p.normal), 0.0f);
    }
    detail::eye_hits<typename TestFixture::B> hits(b, points.size());
    hits.points = b.upload(std::span<const glm::vec4>(points));
    hits.surfaces = b.upload(std::span<const glm::vec4>(normals));
    auto irradiance = b.template make<glm::vec4>(points.size());
    detail::direct_light(b, device, hits, settings, 0, points.size(), irradiance);
    const auto light = b.download(irradiance);
    for (std::size_t i = 0; i < points.size(); ++i) {
        dvec3 sum(0);
        for (int e = 0; e < 4; ++e) {
            const dvec3 a = glm::normalize(corners[e] - places[i].point),
                        c = glm::normalize(corners[(e + 1) % 4] - places[i].point);
            sum += std::acos(glm::dot(a, c)) * glm::normalize(glm::cross(a, c));
        }
        const double factor
            = std::abs(glm::dot(sum, places[i].normal)) / (2 * M_PI); // of the hemisphere, cosine-weighted
        for (int c = 0; c < 3; ++c) {
            const double irradiance = lamp.power[c] / area * factor;
            EXPECT_NEAR(light[i][c], irradiance, 0.01 * irradiance) << "place " << i;
        }
    }
}

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

TYPED_TEST_P(pictures, a_glass_ball_focuses_the_power_that_optics_predicts)
{
    const ball_over_floor ball;
    const scene s = ball.as_scene();
    const double within = 0.12; // m from the axis on the floor
    const double expected = ball.power_on_floor(within);

    auto& b = this->b();
    const auto device = upload_scene(b, s);
    const auto t = trace_photons(b, s, device, s.render);
    const auto positions = b.download(t.photons.positions);
    const auto powers = b.download(t.photons.powers);
    double power = 0, squares = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const dvec3 p = dvec3(positions[i]) + device.layout.center;
        if (std::hypot(p.x, p.z) > within)
            continue;
        power += static_cast<double>(powers[i].x);
        squares += static_cast<double>(powers[i].x) * static_cast<double>(powers[i].x);
    }
    // Light reflected twice and more inside the ball adds a little.
    EXPECT_GT(power, expected - 4 * std::sqrt(squares));
    EXPECT_LT(power, expected * 1.02 + 4 * std::sqrt(squares));
    EXPECT_GT(expected, 0.01);
}

} // namespace photongrid::testing
