// Whether the noise and the bias that a picture reports of its pixels cover its true error, where the light is known.
#pragma once

#include "../backends/serial_pictures.hpp"

namespace photongrid::testing {
namespace {

    /// A floor under a mirror and a small lamp: caustic light falls as from a lamp above the mirror, on all of the
    /// floor if the mirror is large, else on a square with a sharp rim.
    struct mirrored_floor {
        double mirror = 3, lamp = 1, height = 1.25; ///< half its side, heights of lamp and mirror above the floor, m
        double power = 100;                         ///< W

        scene of() const
        {
            scene s;
            s.name = "mirrored_floor";
            s.materials = {{"white", material_kind::lambertian, glm::dvec3(0.5)},
                {"mirror", material_kind::mirror, glm::dvec3(1)}};
            s.polygons = {{{{-0.6, 0, -0.6}, {-0.6, 0, 0.6}, {0.6, 0, 0.6}, {0.6, 0, -0.6}}, 0},
                {{{-mirror, height, -mirror}, {mirror, height, -mirror}, {mirror, height, mirror},
                     {-mirror, height, mirror}},
                    1}};
            s.point_lights = {{"bulb", {0, lamp, 0}, glm::dvec3(power)}};
            s.camera = {{0, 0.9, 0}, {0, 0, 0}, {0, 0, -1}, glm::degrees(2 * std::atan(0.5 / 0.9))};
            s.render = {.map = {.photons = 8000, .grid = {16, 4, 16}},
                .estimate = {.k = 60, .max_radius = 0.5},
                .view = {.spp = 1, .light_samples = 1},
                .output = {.width = 24, .height = 24}};
            s.render.output.only = light_part::caustic;
            s.render.output.report_bias = bias_report::yes;
            return s;
        }
        /// Radiance at a place of the floor.
        double known(double x, double z) const
        {
            const double up = 2 * height - lamp, d2 = up * up + x * x + z * z;
            return std::max(std::abs(x), std::abs(z)) < reach()
                ? 0.5 / M_PI * power / (4 * M_PI) * up / (d2 * std::sqrt(d2))
                : 0;
        }
        /// How far the light reaches on the floor.
        double reach() const { return mirror * (2 * height - lamp) / (height - lamp); }
    };

    /// In at least nine of ten pixels, and of the picture's mean.
    TEST(reported_bias, covers_the_true_error_of_known_light)
    {
        serial_backend b;
        struct row {
            const char* name;
            mirrored_floor floor;
            radius_kind radii;
            double least_gain; ///< of the covered share by reporting bias
        };
        const mirrored_floor even{}, square{.mirror = 0.06};
        for (const auto& r :
            {row{"even", even, radius_kind::per_pass, 0}, row{"square", square, radius_kind::per_pass, 0.1},
                row{"square, shrinking", square, radius_kind::shrinking, 0.02}}) {
            auto s = r.floor.of();
            s.render.estimate.radii = r.radii;
            s.render.output.passes = 24;
            progressive_render<serial_backend> drawing(b);
            drawing.start(s, s.render, {.enabled = false});
            drawing.step();
            const film sum = drawing.state().film;
            double covered = 0, by_noise = 0, difference = 0, interval = 0, n = 0;
            std::size_t next = 0;
            sum.visit_spread([&](double mean, double noise) {
                const auto i = next++;
                const double x = ((static_cast<double>(i % 24) + 0.5) / 24 - 0.5),
                             z = ((static_cast<double>(i / 24) + 0.5) / 24 - 0.5);
                if (std::abs(std::max(std::abs(x), std::abs(z)) - r.floor.reach()) < 1.0 / 24)
                    return; // the rim runs through the pixel
                const double bias = std::abs(sum.bias_of(i)), error = mean - r.floor.known(x, z);
                covered += std::abs(error) <= 2 * (noise + bias) + 1e-9 ? 1 : 0;
                by_noise += std::abs(error) <= 2 * noise + 1e-9 ? 1 : 0;
                difference += error;
                interval += noise + bias;
                ++n;
            });
            std::printf("%s: within 2 (noise + bias) %.3f, within 2 noise %.3f; mean off by %.5f, interval %.5f\n",
                r.name, covered / n, by_noise / n, difference / n, 2 * interval / n);
            EXPECT_GE(covered / n, 0.9) << r.name;
            EXPECT_GE(covered / n, by_noise / n + r.least_gain) << r.name;
            EXPECT_LE(std::abs(difference), 2 * interval) << r.name;
        }
    }

} // namespace
} // namespace photongrid::testing
