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
    detail::direct_light(b, device, {settings, 0, launch(points.size())}, hits, irradiance);
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

TYPED_TEST_P(pictures, a_glass_ball_focuses_the_power_that_optics_predicts)
{
    const ball_over_floor ball;
    this->expect_focus(ball.as_scene(), ball);
}

} // namespace photongrid::testing
