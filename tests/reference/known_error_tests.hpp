// How exact pictures (as_exact) converge, and whether pictures report their error: --until-error, noise and bias.
// Against light that is known, and the mean of many passes.
#pragma once

#include <photongrid/backends/any/any.hpp>
#include <photongrid/io/scene_file.hpp>
#include <photongrid/render/picture_error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace photongrid::testing {
namespace {

    /// Exact passes of one eye ray, shadow ray and path per pixel.
    render_settings cheap_exact(render_settings s)
    {
        s = as_exact(s);
        s.view.spp = s.view.light_samples = s.estimate.gather_rays = 1;
        return s;
    }

    /// A scene drawn by them whose light is known.
    struct known_scene {
        scene s;
        std::vector<double> light; ///< of its pixels, W/(m^2 sr); grey
    };

    /// `s`, which shows a plane y = 0, seen straight from above: means of radiance over pixels by quadrature.
    template <class Radiance>
    known_scene seen_from_above(scene s, light_part only, const Radiance& radiance)
    {
        s.render = cheap_exact(s.render);
        s.render.output.only = only;
        const auto& o = s.render.output;
        std::vector<double> light;
        const double pixel
            = 2 * s.camera.position.y * std::tan(s.camera.vertical_fov * std::numbers::pi / 360) / o.height;
        const dvec3 right = glm::normalize(glm::cross(s.camera.look_at - s.camera.position, s.camera.up));
        constexpr int steps = 8;
        for (std::uint32_t y = 0; y < o.height; ++y)
            for (std::uint32_t x = 0; x < o.width; ++x) {
                double sum = 0;
                for (int i = 0; i < steps * steps; ++i) {
                    const double across = x + (i % steps + 0.5) / steps - 0.5 * o.width,
                                 down = y + (i / steps + 0.5) / steps - 0.5 * o.height;
                    sum += radiance(s.camera.look_at + pixel * (across * right - down * s.camera.up));
                }
                light.push_back(sum / (steps * steps));
            }
        return {s, light};
    }

    /// A floor before a wall in the plane x = 1.
    scene floor_before_a_wall(double of_floor, const material& wall)
    {
        scene s;
        s.materials = {{"white", material_kind::lambertian, dvec3(of_floor)}, wall};
        s.polygons = {
            {{{-3, 0, -3}, {-3, 0, 3}, {1, 0, 3}, {1, 0, -3}}, 0}, {{{1, 0, -3}, {1, 0, 3}, {1, 3, 3}, {1, 3, -3}}, 1}};
        s.camera = {{0.3, 2, 0}, {0.3, 0, 0}, {0, 0, 1}, 30};
        s.render = {.map = {.photons = 1000, .builder = map_builder::automatic, .grid = glm::uvec3(0)},
            .estimate = {.k = 20, .max_radius = 2},
            .output = {.width = 16, .height = 16}};
        return s;
    }

    /// A mirror shows the floor a second bulb, behind it: its light is a caustic, the only light that is drawn.
    known_scene second_bulb_in_a_mirror()
    {
        auto s = floor_before_a_wall(0.5, {"wall", material_kind::mirror, dvec3(1)});
        s.point_lights = {{"bulb", {0.4, 0.5, 0}, dvec3(4 * std::numbers::pi)}};
        return seen_from_above(std::move(s), light_part::caustic, [](const dvec3& p) {
            const dvec3 to = dvec3(1.6, 0.5, 0) - p;
            return 0.5 / std::numbers::pi * to.y / std::pow(glm::length(to), 3);
        });
    }

    /// A dark floor, which lights the wall little, before a diffuse wall that the sun lights: its indirect light alone
    /// is drawn. By the form factor of a rectangle that stands on the floor's plane, for a point of the floor
    /// (Lambert).
    known_scene floor_before_a_sunlit_wall()
    {
        auto s = floor_before_a_wall(1e-4, {"wall", material_kind::lambertian, dvec3(0.8)});
        s.directional_lights = {{"sun", {1, 0, 0}, dvec3(3e5)}};
        return seen_from_above(std::move(s), light_part::indirect, [](const dvec3& p) {
            const double x = 1 - p.x, top = std::hypot(x, 3.0), a = 3 - p.z, b = 3 + p.z;
            const double factor
                = (std::atan(a / x) + std::atan(b / x) - x / top * (std::atan(a / top) + std::atan(b / top)))
                / (2 * std::numbers::pi);
            return 1e-4 / std::numbers::pi * factor * 0.8 * 3e5;
        });
    }

    film drawn(renderer& drawing, const scene& s, const render_settings& settings)
    {
        drawing.start(s, settings, {.enabled = false});
        drawing.step();
        return drawing.state().film;
    }

    struct known_pixel {
        double mean = 0, noise = 0, bias = 0;
    };
    std::vector<known_pixel> pixels_of(const film& f)
    {
        std::vector<known_pixel> all;
        f.visit_spread([&](double mean, double error) {
            all.push_back({mean, error, std::abs(f.bias_of(all.size()))});
        });
        return all;
    }

    /// What pictures are compared with, and which of its pixels have noise.
    struct truth {
        std::vector<known_pixel> pixels;
        std::vector<std::size_t> noisy;
        double dark = 0;

        explicit truth(const known_scene& known)
        {
            for (const double light : known.light) {
                noisy.push_back(pixels.size());
                pixels.push_back({light});
            }
            find_dark();
        }
        explicit truth(const film& f) : pixels(pixels_of(f))
        {
            for (std::size_t i = 0; i < pixels.size(); ++i)
                if (detail::is_noisy(pixels[i].mean, pixels[i].noise))
                    noisy.push_back(i);
            find_dark();
        }
        /// The error that so many of the noisy pixels do not exceed.
        double error_of(const film& f, double share) const
        {
            const auto found = pixels_of(f);
            std::vector<double> errors;
            for (const auto i : noisy)
                errors.push_back(std::abs(found[i].mean - pixels[i].mean) / (pixels[i].mean + dark));
            const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(errors.size()));
            std::nth_element(errors.begin(), errors.begin() + at, errors.end());
            return errors[static_cast<std::size_t>(at)];
        }

    private:
        void find_dark()
        {
            for (const auto i : noisy)
                dark += pixels[i].mean * detail::dark_share / static_cast<double>(noisy.size());
        }
    };

    std::unique_ptr<renderer> renderer_on_cpu() { return make_renderer({.backend = "cpu"}); }

    scene blocks(std::uint32_t size)
    {
        auto s = read_scene(PHOTONGRID_SCENES "/cornell_blocks.json");
        s.render.output.width = s.render.output.height = size;
        s.render.map.photons = 20000;
        s.render.estimate.k = 400;
        s.render.estimate.max_radius = 0.15;
        s.render.view.light_samples = 2;
        s.render.view.spp = 1;
        s.render.output.passes = 10;
        s.render = with_numbers(s.render, {});
        return s;
    }

    /// Prints the mean relMSE of seeds after 1, 2, 4 ... passes, and returns the slope of its logarithm.
    double slope_of_exact_pictures(const char* name, const known_scene& known)
    {
        constexpr std::uint32_t passes = 2048, seeds = 4;
        std::vector<double> errors(12);
        const auto drawing = renderer_on_cpu();
        auto settings = known.s.render;
        settings.output.passes = passes;
        for (settings.seed = 1; settings.seed <= seeds; ++settings.seed) {
            drawing->start(known.s, settings, {.enabled = false});
            for (std::size_t row = 0; row < errors.size(); ++row) {
                while (drawing->progress().passes < 1u << row)
                    drawing->step(renderer::milliseconds(0));
                const auto picture = drawing->picture();
                for (std::size_t i = 0; i < known.light.size(); ++i) {
                    const double light = known.light[i], off = static_cast<double>(picture.pixels[i].y) - light;
                    errors[row] += std::pow(off / (light + 0.01), 2) / static_cast<double>(known.light.size() * seeds);
                }
            }
        }
        std::printf("%s\n\n| passes | relMSE |\n|---|---|\n", name);
        double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
        for (std::size_t row = 0; row < errors.size(); ++row) {
            const double x = static_cast<double>(row) * std::log(2.0), y = std::log(errors[row]);
            ++n, sx += x, sy += y, sxx += x * x, sxy += x * y;
            std::printf("| %u | %.3g |\n", 1u << row, errors[row]);
        }
        const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
        std::printf("| slope | %.2f |\n\n", slope);
        return slope;
    }

    TEST(validation, long_exact_pictures_of_known_light_converge_at_the_rate_of_theory)
    {
        EXPECT_NEAR(slope_of_exact_pictures("a second bulb in a mirror", second_bulb_in_a_mirror()), -2.0 / 3, 0.1);
        // Passes share out their rays: steeper than -1.
        EXPECT_LT(slope_of_exact_pictures("a floor before a sunlit wall", floor_before_a_sunlit_wall()), -0.9);
    }

    TEST(validation, long_pictures_that_an_error_ends_have_it)
    {
        const auto drawing = renderer_on_cpu();
        std::printf("| scene | asked for | passes | claimed | true | true / claimed |\n|---|---|---|---|---|---|\n");
        const auto expect = [&](const char* name, const scene& s, const truth& known, double least) {
            render_state state;
            for (const double bound : {0.2, 0.1}) {
                auto settings = s.render;
                settings.output.passes = 1; // the error ends them
                settings.output.until_error = bound;
                drawing->start(s, settings, {.enabled = false});
                if (!state.empty())
                    drawing->resume(state);
                drawing->step();
                state = drawing->state();
                const auto& end = drawing->stats().end;
                const double actual = known.error_of(state.film, settings.output.percentile);
                std::printf("| %s | %g | %.0f | %.4f | %.4f | %.2f |\n", name, bound, static_cast<double>(end.passes),
                    end.error, actual, actual / end.error);
                EXPECT_LT(actual, 2 * end.error) << name << ", " << bound;
                EXPECT_GT(actual, least * end.error) << name << ", " << bound;
            }
        };
        const auto bulb = second_bulb_in_a_mirror(), wall = floor_before_a_sunlit_wall();
        expect("second_bulb", bulb.s, truth(bulb), 0.5);
        // Passes share out its rays, so the spread of groups overstates the noise.
        expect("sunlit_wall", wall.s, truth(wall), 0.4);
        const auto s = blocks(32);
        auto many = cheap_exact(s.render);
        many.seed = 1000;
        many.output.passes = 2000;
        expect("cornell_blocks", s, truth(drawn(*drawing, s, many)), 0.5);
    }

    TEST(validation, long_noise_and_bias_cover_the_true_error_of_cornell_blocks)
    {
        const auto drawing = renderer_on_cpu();
        const auto s = blocks(48);
        auto settings = s.render;
        settings.view.spp = 1;
        auto exact = settings; // its radii are much smaller; its noise counts with the pixels' own
        exact.seed = 1000;
        exact.estimate.k = 6;
        exact.estimate.radii = radius_kind::shrinking;
        exact.output.passes = 300;
        const truth known(drawn(*drawing, s, exact));
        settings.estimate.k = 50;
        settings.output.report_bias = bias_report::yes;
        std::printf(
            "| radii | passes | within 2 (noise + bias) | within 2 noise | claimed / true |\n|---|---|---|---|---|\n");
        for (const auto radii : {radius_kind::per_pass, radius_kind::shrinking})
            for (const std::uint32_t passes : {4u, 16u}) {
                settings.estimate.radii = radii;
                settings.output.passes = passes;
                const auto f = drawn(*drawing, s, settings);
                const auto found = pixels_of(f);
                double covered = 0, by_noise = 0;
                for (const auto i : known.noisy) {
                    const double error = std::abs(found[i].mean - known.pixels[i].mean),
                                 noise = std::hypot(found[i].noise, known.pixels[i].noise);
                    covered += error <= 2 * (noise + found[i].bias) ? 1 : 0;
                    by_noise += error <= 2 * noise ? 1 : 0;
                }
                const auto n = static_cast<double>(known.noisy.size());
                const char* name = radii == radius_kind::per_pass ? "per pass" : "shrinking";
                std::printf("| %s | %u | %.3f | %.3f | %.2f |\n", name, passes, covered / n, by_noise / n,
                    picture_error(f, 0.95) / known.error_of(f, 0.95));
                EXPECT_GE(covered / n, 0.9) << name << ", " << passes;
            }
    }

} // namespace
} // namespace photongrid::testing
