// Spotlights, spheres, directional light and environments in the reference renderer: known light, and caustics by light
// paths of all kinds of lights.
#pragma once

#include "mirror_and_glass_tests.hpp"

namespace photongrid {
namespace {

    /// The radiance of a white floor, seen at `point`, by direct light alone.
    void expect_irradiance(const scene& s, const dvec3& point, double irradiance)
    {
        auto settings = quick(4, 4, 4000);
        settings.photon_depth = 1;
        expect_agrees(render_reference(s, looking_at(point + dvec3(0.3, 0.7, -0.4), point), settings),
            irradiance * 0.8 / M_PI, 0.01);
    }

    TEST(reference_lights, have_the_irradiance_of_their_formulas)
    {
        const auto floors = testing::floors_under_each_light();
        // The spot: t is linear in the cosine between 40 and 15 degrees.
        const auto& spot = floors[0].spot_lights[0];
        for (const dvec3& p : {dvec3(0.3, 0, 0.1), dvec3(-0.3, 0, 0.2), dvec3(2, 0, 0)}) {
            const dvec3 d = p - spot.position;
            const double r = glm::length(d), outer = std::cos(glm::radians(40.0)), inner = std::cos(glm::radians(15.0));
            const double t
                = std::clamp((glm::dot(d, glm::normalize(spot.direction)) / r - outer) / (inner - outer), 0.0, 1.0);
            const double intensity = 10 / (2 * M_PI * ((1 - inner) + (inner - outer) / 2)) * t * t * (3 - 2 * t);
            if (intensity > 0)
                expect_irradiance(floors[0], p, intensity * 1.1 / (r * r * r));
            else
                expect_dark(render_reference(floors[0], looking_at(p + dvec3(0.3, 0.7, -0.4), p), quick(4, 4, 16)));
        }
        const dvec3 p(-0.5, 0, 0.7), to = floors[1].sphere_lights[0].center - p;
        expect_irradiance(floors[1], p, 10 / (4 * M_PI) * to.y / std::pow(glm::length(to), 3));
        // A mesh of one triangle, by Lambert's formula: a term for each edge.
        auto s = testing::bare_floor();
        const std::array<dvec3, 3> corners{dvec3(-0.4, 1.2, 0.3), dvec3(0.5, 0.9, 0.1), dvec3(0.1, 1.1, -0.6)};
        mesh triangle{{}, {{0, 2, 1}}, {}, {}, {}}; // its front looks down
        for (const auto& c : corners)
            triangle.positions.emplace_back(c);
        s.mesh_lights
            = {{"ember", {"", std::make_shared<const mesh>(triangle), glm::dmat3(1), dvec3(0), 0}, dvec3(10, 5, 2)}};
        for (const dvec3& q : {dvec3(-0.3, 0, -0.9), dvec3(1, 0, 0), dvec3(0.3, 0, 1)}) {
            double projected = 0;
            for (int i = 0; i < 3; ++i) {
                const dvec3 a = corners[static_cast<std::size_t>(i)] - q,
                            b = corners[static_cast<std::size_t>((i + 1) % 3)] - q, n = glm::cross(a, b);
                projected += std::atan2(glm::length(n), glm::dot(a, b)) * n.y / glm::length(n);
            }
            const double area = glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) / 2;
            expect_irradiance(s, q, 10 / (M_PI * area) * std::abs(projected) / 2);
        }
        expect_irradiance(floors[2], p, 3 * 2 / std::sqrt(0.09 + 4 + 0.25));
        expect_irradiance(floors[4], p, M_PI);
    }

    TEST(reference_lights, are_seen_where_rays_end_on_them)
    {
        auto s = testing::bare_floor();
        s.environment_lights = {{"sky", "", testing::sky_with_a_sun(), dvec3(2, 1, 1)}};
        s.sphere_lights = {{"globe", {0, 5, 0}, 0.5, dvec3(4)}};
        // Column 17 of 24 and row 3 of 12.
        const dvec3 sun = environment_direction(17.5 / 24, 3.5 / 12);
        const auto seen
            = overall(render_reference(s, looking_at({0, 1, 0}, dvec3(0, 1, 0) + sun), quick(2, 2, 4))).mean;
        EXPECT_NEAR(seen.x, 120, 1e-4);
        EXPECT_NEAR(seen.y, 50, 1e-4);
        EXPECT_NEAR(overall(render_reference(s, looking_at({0, 1, 0}, {0.1, 5, 0}), quick(2, 2, 4))).mean.x,
            4 / (M_PI * 4 * M_PI * 0.25), 1e-6);
    }

    TEST(reference_lights, of_all_kinds_shine_through_glass_of_index_one)
    {
        for (auto s : testing::floors_under_each_light()) {
            const camera eye{{0, 1.2, 3}, {0, 0.2, 0}, {0, 1, 0}, 40};
            const auto without = render_reference(s, eye, quick(8, 8, 4000));
            // All light goes through it once: no shadow's edge shows the size of the bins.
            if (s.spot_lights.empty() && s.sphere_lights.empty())
                s.spheres = {{{0, 0.5, 0}, 6, 1}};
            else
                s.polygons.push_back({{{-4, 0.3, -4}, {-4, 0.3, 4}, {4, 0.3, 4}, {4, 0.3, -4}}, 1});
            auto settings = quick(8, 8, 4000);
            settings.paths = 3000000;
            settings.bin = s.spot_lights.empty() ? 0.1 : 0.02; // its light is uneven
            settings.area_light_caustics = caustics_by::bins;
            const auto z = compare_by_error(render_reference(s, eye, settings), without);
            EXPECT_LT(z.mean_square, 1.9)
                << "lights: " << s.spot_lights.size() << s.sphere_lights.size() << s.directional_lights.size();
            EXPECT_LT(std::abs(z.sum), 4)
                << "lights: " << s.spot_lights.size() << s.sphere_lights.size() << s.directional_lights.size();
        }
    }

} // namespace
} // namespace photongrid
