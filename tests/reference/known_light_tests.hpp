// Light that is known in closed form.
#pragma once

#include "reference_under_test.hpp"

namespace photongrid {
namespace {

    // --- light that is known in closed form ---
    TEST(reference, integrating_sphere_has_the_irradiance_of_a_geometric_series)
    {
        for (const double rho : {0.3, 0.8}) {
            auto s = testing::integrating_sphere(dvec3(rho));
            s.point_lights[0].position = dvec3(0.3, -0.2, 0.1); // off the middle: only direct light is then uneven
            auto settings = quick(8, 6, 400);
            settings.photon_depth = 200;
            const auto deep = render_reference(s, s.camera, settings);
            settings.photon_depth = 1;
            const auto direct = render_reference(s, s.camera, settings);
            settings.photon_depth = 3;
            const auto three = render_reference(s, s.camera, settings);
            // Indirect irradiance Phi rho / (4 pi R^2 (1 - rho)) is even; Phi / (4 pi R^2) is pi here.
            const double mean_direct = overall(direct).mean.x;
            expect_agrees(deep, mean_direct + rho * rho / (1 - rho), 0.01);
            expect_agrees(three, mean_direct + rho * (rho + rho * rho), 0.01);
        }
        const auto s = testing::integrating_sphere(dvec3(0.5));
        auto settings = quick(8, 6, 100);
        settings.photon_depth = 200;
        expect_agrees(render_reference(s, s.camera, settings), 1, 0.01); // rho / (1 - rho)
    }

    // The edge of a lamp goes between two pixels. Under a tent of two pixels' width, an eighth of the area of each lies
    // beyond it.
    TEST(reference, pixel_filter_weighs_the_edge_of_a_lamp)
    {
        scene s = empty_scene();
        s.disks = {{dvec3(0, 0, 9), {0, 0, -1}, 5, white}};
        s.rectangle_lights = {{"lamp", {0, -20, 0}, {20, 0, 0}, {0, 40, 0}, dvec3(M_PI * 800)}};
        const camera view{
            {0, 0, 5}, dvec3(0), {0, 1, 0}, glm::degrees(2 * std::atan(0.4))}; // pixels of 1 m at the lamp
        auto settings = quick(6, 4, 40'000);
        settings.photon_depth = 1;
        const auto columns = [&](pixel_filter filter) {
            settings.filter = filter;
            const auto picture = render_reference(s, view, settings).mean;
            std::vector<double> all;
            for (std::size_t x = 0; x < 6; ++x)
                all.push_back(static_cast<double>(picture.pixels[6 + x].x));
            return all;
        };
        EXPECT_EQ(columns(pixel_filter::box), (std::vector<double>{0, 0, 0, 1, 1, 1}));
        const auto tent = columns(pixel_filter::tent);
        EXPECT_EQ(tent[1], 0);
        EXPECT_NEAR(tent[2], 0.125, 0.007); // four standard errors
        EXPECT_NEAR(tent[3], 0.875, 0.007);
        EXPECT_EQ(tent[4], 1);
    }

    TEST(reference, point_light_falls_off_with_the_square_and_the_cosine)
    {
        scene s = empty_scene();
        s.disks = {{dvec3(0), {0, 1, 0}, 5, white}};
        s.point_lights = {{"a", {1, 2, 0}, dvec3(7)}, {"b", {0, 1, 3}, dvec3(3)}};
        auto settings = quick(4, 4, 4000);
        settings.photon_depth = 1;
        const double expected = 7 / (4 * M_PI) * 2 / std::pow(5, 1.5) + 3 / (4 * M_PI) * 1 / std::pow(10, 1.5);
        expect_agrees(render_reference(s, looking_at({0, 3, -1}, dvec3(0)), settings), expected / M_PI, 0.005);
        s.disks.push_back({{0.5, 1, 0}, {0, 1, 0}, 0.1, white}); // hides lamp a
        expect_agrees(render_reference(s, looking_at({0, 3, -1}, dvec3(0)), settings),
            3 / (4 * M_PI) / std::pow(10, 1.5) / M_PI, 0.02);
        expect_dark(render_reference(s, looking_at({0, -3, -1}, dvec3(0)), settings)); // the other side is dark
    }

    TEST(reference, rectangle_light_has_the_form_factors_of_the_textbook)
    {
        // Differential area under the corner of a rectangle a x b at distance c, parallel and at right angles
        // (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3 and B-4).
        const double a = 1.2, b = 0.7, c = 0.5, power = 9, radiance = power / (M_PI * a * b);
        const auto parallel = [](double x, double y) {
            const double p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
            return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * M_PI);
        };
        const auto right_angles = [](double x, double y) {
            return (std::atan(1 / y) - y / std::hypot(x, y) * std::atan(1 / std::hypot(x, y))) / (2 * M_PI);
        };
        scene s = empty_scene();
        s.disks = {{dvec3(0), {0, 1, 0}, 0.2, white}};
        s.rectangle_lights = {{"ceiling", {0, c, 0}, {a, 0, 0}, {0, 0, b}, dvec3(power)}}; // u x v = -y: facing down
        expect_agrees(render_reference(s, looking_at({-1, 0.4, 0}, dvec3(0)), quick(8, 8, 2000)),
            radiance * parallel(a / c, b / c), 0.003);
        // Upright at distance c, b along the edge, a up: B-4 with X = a / b, Y = c / b.
        s.rectangle_lights = {{"wall", {c, 0, 0}, {0, 0, b}, {0, a, 0}, dvec3(power)}}; // u x v = -x
        expect_agrees(render_reference(s, looking_at({-1, 0.4, 0}, dvec3(0)), quick(8, 8, 2000)),
            radiance * right_angles(a / b, c / b), 0.003);
        s.rectangle_lights = {{"wall", {c, 0, 0}, {0, a, 0}, {0, 0, b}, dvec3(power)}}; // its back
        expect_dark(render_reference(s, looking_at({-1, 0.4, 0}, dvec3(0)), quick(2, 2, 100)));
        // Seen itself it shows its radiance, in front only.
        expect_agrees(render_reference(s, looking_at({2, 0.5, 0.3}, {c, 0.5, 0.3}), quick(2, 2, 4)), radiance, 1e-6);
        expect_dark(render_reference(s, looking_at({-1, 0.5, 0.3}, {c, 0.5, 0.3}), quick(2, 2, 4)));
    }

} // namespace
} // namespace photongrid
