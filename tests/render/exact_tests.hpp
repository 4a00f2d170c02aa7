// Pictures that converge to the exact one (as_exact): known light of paths and caustics, and how fast errors fall.
#pragma once

#include "shrinking_radii_tests.hpp"

#include <map>

namespace photongrid::testing {

inline render_settings by_paths(render_settings s, std::uint32_t paths)
{
    s.estimate.indirect = indirect_kind::paths;
    s.estimate.gather_rays = paths;
    return s;
}

/// Paths go on for as long as light does: in a sphere of reflectance 0.75 a quarter of it has met five surfaces.
TYPED_TEST_P(pictures, paths_in_a_closed_sphere_have_the_known_radiance)
{
    const dvec3 reflectance(0.5, 0.25, 0.75);
    auto s = integrating_sphere(reflectance);
    auto settings = by_paths(s.render, 16);
    settings.output.width = 16;
    settings.output.height = 12;
    for (const auto part : {light_part::all, light_part::indirect}) {
        settings.output.only = part;
        render_stats stats;
        expect_radiance_in_a_sphere(this->picture(s, settings, &stats), reflectance, part);
        EXPECT_EQ(stats.photons.emitted, 0u) << "nothing in the sphere makes caustics";
    }
}

TYPED_TEST_P(pictures, paths_have_the_known_radiance_in_a_corner)
{
    const double wall = 0.8, floor = 0.02, height = 1, sun = 3;
    const auto s = sunlit_corner(wall, floor, height, sun);
    auto settings = by_paths(s.render, 256);
    settings.output.only = light_part::indirect;
    const auto drawn = this->picture(s, settings);
    double seen = 0, known = 0;
    for (std::uint32_t y = 0; y < 8; ++y)
        for (std::uint32_t x = 0; x < 8; ++x) {
            const dvec3 d = through_pixel(s.camera, settings.output, x, y);
            const double from_wall = (s.camera.position - d * (s.camera.position.y / d.y)).x;
            const double form_factor = (1 - from_wall / std::hypot(from_wall, height)) / 2;
            known += floor / M_PI * form_factor * wall * sun;
            seen += static_cast<double>(drawn.pixels[y * 8 + x].x);
        }
    EXPECT_NEAR(seen / known, 1, 0.02);
}

TYPED_TEST_P(pictures, paths_equal_serials)
{
    auto& b = this->b();
    if (!b.caps().exact_division || !b.caps().exact_sqrt)
        GTEST_SKIP() << "this device rounds division or square root loosely";
    serial_backend serial;
    for (const auto& s : {small_cornell(), all_shapes()}) {
        auto settings = by_paths(shrinking(s.render, 2), 2);
        settings.map.photons /= 4;
        settings.output.width = 24;
        settings.output.height = 18;
        EXPECT_LE(relative_mse(render(b, s, settings).picture, render(serial, s, settings).picture), 1e-9) << s.name;
    }
}

/// Previews, bands and states change no byte of an exact picture.
TYPED_TEST_P(pictures, an_exact_picture_does_not_depend_on_how_it_is_run)
{
    const auto s = small_cornell();
    auto settings = s.render;
    settings.output.passes = 2;
    settings = as_exact(settings);
    settings.estimate.gather_rays = 1;
    settings.map.photons /= 4;
    settings.output.width = 24;
    settings.output.height = 18;
    const auto whole = this->expect_the_same_however_it_is_run(s, settings, {.enabled = true});
    settings.output.band = 100;
    EXPECT_LE(relative_mse(this->picture(s, settings), whole), 1e-9);
}

/// Sums of squared errors relative to `known`, after some numbers of passes.
template <class Device>
std::map<std::uint32_t, double> errors_after(Device& b, const scene& s, render_settings settings,
    const std::vector<double>& known, const std::vector<std::uint32_t>& numbers)
{
    std::map<std::uint32_t, double> errors;
    for (std::uint32_t seed = 1; seed <= 4; ++seed)
        for (const auto passes : numbers) {
            settings.output.passes = passes;
            settings.seed = seed;
            const auto drawn = render(b, s, settings).picture;
            for (std::size_t i = 0; i < known.size(); ++i)
                errors[passes] += std::pow(static_cast<double>(drawn.pixels[i].x) / known[i] - 1, 2);
        }
    return errors;
}

/// A mirror shows a floor a second bulb, behind it. The error of that light falls at the rate of theory, as the passes
/// to the power of -2/3, and to well below the first pass's.
TYPED_TEST_P(pictures, an_exact_caustic_converges_at_the_rate_of_theory)
{
    scene s;
    s.name = "second_bulb";
    s.materials = {{"white", material_kind::lambertian, dvec3(0.5)}, {"mirror", material_kind::mirror, dvec3(1)}};
    s.polygons
        = {{{{-3, 0, -3}, {-3, 0, 3}, {1, 0, 3}, {1, 0, -3}}, 0}, {{{1, 0, -3}, {1, 0, 3}, {1, 3, 3}, {1, 3, -3}}, 1}};
    s.point_lights = {{"bulb", {0.4, 0.5, 0}, dvec3(4 * M_PI)}};
    s.camera = {{0.3, 2, 0}, {0.3, 0, 0}, {0, 0, 1}, 30};
    s.render = {.map = {.photons = 500, .builder = map_builder::automatic, .grid = glm::uvec3(0)},
        .estimate = {.k = 20, .max_radius = 2},
        .view = {.spp = 1, .light_samples = 1},
        .output = {.width = 12, .height = 12}};
    s.render.output.only = light_part::caustic;
    s.render = as_exact(s.render);
    std::vector<double> known;
    for (std::uint32_t y = 0; y < 12; ++y)
        for (std::uint32_t x = 0; x < 12; ++x) {
            const dvec3 d = through_pixel(s.camera, s.render.output, x, y);
            const dvec3 to = dvec3(1.6, 0.5, 0) - (s.camera.position - d * (s.camera.position.y / d.y));
            known.push_back(0.5 / M_PI * to.y / std::pow(glm::length(to), 3));
        }
    const auto errors = errors_after(this->b(), s, s.render, known, {4, 64});
    const double slope = std::log(errors.at(64) / errors.at(4)) / std::log(16);
    EXPECT_NEAR(slope, -2.0 / 3, 0.1);
    EXPECT_LT(errors.at(64) / (4 * 144), 0.02);
}

/// Light without caustics has no radius: its error falls as the number of passes does, or faster.
TYPED_TEST_P(pictures, exact_indirect_light_converges_as_fast_as_noise)
{
    auto s = sunlit_corner(0.8, 0.02, 1, 3);
    s.render.output.only = light_part::indirect;
    s.render = by_paths(as_exact(s.render), 1);
    std::vector<double> known;
    for (std::uint32_t y = 0; y < 8; ++y)
        for (std::uint32_t x = 0; x < 8; ++x) {
            const dvec3 d = through_pixel(s.camera, s.render.output, x, y);
            const double from_wall = (s.camera.position - d * (s.camera.position.y / d.y)).x;
            known.push_back(0.02 / M_PI * (1 - from_wall / std::hypot(from_wall, 1)) / 2 * 0.8 * 3);
        }
    const auto errors = errors_after(this->b(), s, s.render, known, {4, 64});
    EXPECT_LT(std::log(errors.at(64) / errors.at(4)) / std::log(16), -0.9);
}

} // namespace photongrid::testing
