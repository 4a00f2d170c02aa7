// Radii that shrink from pass to pass (their sequence: passes.cpp): the radii used, and pictures that do not depend on
// how passes are run.
#pragma once

#include "final_gather_tests.hpp"

#include <photongrid/render/render.hpp>

namespace photongrid::testing {

inline render_settings shrinking(render_settings s, std::uint32_t passes)
{
    s.estimate.radii = radius_kind::shrinking;
    s.output.passes = passes;
    return s;
}

/// The layer of radii tells them: with the same map for both, a pass with a quarter of the squared radius has half the
/// radius of the search for k at every pixel, and finds a quarter of its photons on the average.
TYPED_TEST_P(pictures, passes_have_the_radii_of_the_first_map_made_smaller)
{
    auto& b = this->b();
    const auto s = small_cornell();
    auto settings = s.render;
    settings.output.width = 24;
    settings.output.height = 18;
    settings.output.aov = true;
    settings.estimate.k = 40;
    settings.estimate.max_radius = 2;
    const auto first = build_map(b, s, settings_of_pass(settings, radius_pass));
    auto other = settings_of_pass(settings, 5);
    const auto map = build_map(b, s, other);
    const auto layers = [&](const built_map<typename TestFixture::B>& of, const auto& radii) {
        render_stats stats;
        film sum(settings.output.width, settings.output.height, 1, true);
        sum.add(0, draw_pass(b, of, s.camera, other, stats, {.radii = radii}));
        return sum.picture().picture.layers;
    };
    using radii = pass_radii<typename TestFixture::B>;
    const auto whole = layers(first, radii{});
    for (const auto* of : {&first, &map}) {
        const auto half = layers(*of, radii{.firsts = {{&first.map(), settings.estimate.k}}, .share2 = 0.25});
        double photons = 0, of_whole = 0;
        for (std::size_t i = 0; i < whole.radius.size(); ++i) {
            ASSERT_NEAR(half.radius[i], 0.5f * whole.radius[i], 1e-5f * whole.radius[i]) << i;
            photons += static_cast<double>(half.count[i]);
            of_whole += static_cast<double>(whole.count[i]);
        }
        EXPECT_GT(of_whole, 1000);
        EXPECT_NEAR(photons / of_whole, 0.25, 0.05);
    }
}

/// The map of the first radii has fewer photons, of which fewer are sought: radii are as large, on the average.
TYPED_TEST_P(pictures, a_map_of_fewer_photons_gives_radii_as_large)
{
    auto& b = this->b();
    const auto s = small_cornell();
    auto settings = shrinking(with_caustic_map(s.render, 4000), 2);
    settings.map.photons = 8000;
    settings.output.width = 32;
    settings.output.height = 24;
    settings.output.aov = true;
    settings.estimate.k = settings.estimate.caustic_k = 100;
    settings.estimate.max_radius = 10;
    const auto first = build_map(b, s, settings_of_radius_map(settings, b.caps()));
    EXPECT_EQ(first.map().photons.size(), 2000u);
    ASSERT_EQ(first.lights.size(), 2u);
    EXPECT_EQ(first.caustics().photons.size(), 1000u);
    const auto map = build_map(b, s, settings_of_pass(settings, 0));
    for (const auto part : {light_part::indirect, light_part::caustic}) {
        auto of_part = settings;
        of_part.output.only = part;
        const auto mean_radius2 = [&](const auto& radii) {
            render_stats stats;
            film sum(settings.output.width, settings.output.height, 1, true);
            sum.add(0, draw_pass(b, map, s.camera, of_part, stats, {.radii = radii}));
            double squares = 0;
            for (const float r : sum.picture().picture.layers.radius)
                squares += static_cast<double>(r) * static_cast<double>(r);
            return squares;
        };
        const auto radii = radii_of_pass(first, settings_of_radius_map(settings, b.caps()), 0);
        EXPECT_NEAR(mean_radius2(radii) / mean_radius2(pass_radii<typename TestFixture::B>{}), 1, 0.1);
    }
}

TYPED_TEST_P(pictures, shrinking_radii_equal_serials)
{
    auto& b = this->b();
    if (!b.caps().exact_division || !b.caps().exact_sqrt)
        GTEST_SKIP() << "this device rounds division or square root loosely";
    serial_backend serial;
    for (const auto& s : {small_cornell(), all_shapes()})
        for (const bool gathers : {false, true}) {
            auto settings = shrinking(gathers ? gathering(s.render, 2) : s.render, 3);
            settings.map.photons /= 4;
            settings.output.width = 24;
            settings.output.height = 18;
            EXPECT_LE(relative_mse(render(b, s, settings).picture, render(serial, s, settings).picture), 1e-9)
                << s.name << (gathers ? ", gathering" : "");
        }
}

/// The layer of biases is serial's, in all of its parts, and asking for it leaves the light alone. Where there is no
/// estimate, or no photon is seen, it is 0.
TYPED_TEST_P(pictures, biases_equal_serials)
{
    auto& b = this->b();
    serial_backend serial;
    for (const auto& s : {small_cornell(), all_shapes()})
        for (const auto edges : {edge_correction::none, edge_correction::polygons, edge_correction::probes}) {
            auto settings = shrinking(s.render, 3);
            settings.map.photons /= 4;
            settings.output.width = 24;
            settings.output.height = 18;
            settings.estimate.edges = edges;
            settings.estimate.leaks.min_cosine = 0.5f;
            const auto plain = this->picture(s, settings);
            EXPECT_TRUE(plain.layers.bias.empty());
            settings.output.report_bias = bias_report::yes;
            const auto reported = this->picture(s, settings);
            EXPECT_TRUE(same_bytes(reported, plain));
            const auto& bias = reported.layers.bias;
            ASSERT_EQ(bias.size(), reported.pixels.size());
            if (!b.caps().exact_division || !b.caps().exact_sqrt)
                continue;
            const auto expected = render(serial, s, settings).picture.layers.bias;
            double squares = 0, differences = 0;
            for (std::size_t i = 0; i < bias.size(); ++i) {
                const double known = static_cast<double>(expected[i]), off = static_cast<double>(bias[i]) - known;
                squares += known * known;
                differences += off * off;
            }
            EXPECT_GT(squares, 0);
            EXPECT_LE(differences, 1e-6 * squares) << s.name;
            settings.output.only = light_part::direct;
            for (const float none : this->picture(s, settings).layers.bias)
                ASSERT_EQ(none, 0);
        }
}

/// Step by step, and from a pass in the middle on, a picture has the same bytes.
TYPED_TEST_P(pictures, shrinking_radii_do_not_depend_on_how_passes_are_run)
{
    const auto s = small_cornell();
    auto settings = shrinking(s.render, 3);
    settings.map.photons /= 4;
    settings.output.width = 24;
    settings.output.height = 18;
    const auto whole = this->expect_the_same_however_it_is_run(s, settings);
    settings.estimate.radii = radius_kind::per_pass;
    EXPECT_FALSE(same_bytes(this->picture(s, settings), whole));
}

/// At the rim of a caustic estimates are blurred. Passes with radii of their own keep that, shrinking ones lose it.
TYPED_TEST_P(pictures, blur_fades_with_shrinking_radii)
{
    // A mirror sends the sun's light up against a ceiling, in a square with a sharp rim.
    scene s;
    s.name = "square_caustic";
    s.materials = {{"white", material_kind::lambertian, dvec3(0.5)}, {"mirror", material_kind::mirror, dvec3(1)}};
    s.polygons = {{{{0, 1, -1}, {1, 1, -1}, {1, 1, 1}, {0, 1, 1}}, 0},
        {{{-0.4, 0, -0.4}, {-0.4, 0, 0.4}, {0.4, 0, 0.4}, {0.4, 0, -0.4}}, 1}};
    s.directional_lights = {{"sun", {0.5, -1, 0}, dvec3(4)}};
    s.camera = {{0.5, 0.05, 0}, {0.5, 1, 0}, {0, 0, 1}, 60};
    s.render = {.map = {.photons = 500, .grid = {8, 4, 8}},
        .estimate = {.k = 66, .max_radius = 1},
        .view = {.spp = 1, .light_samples = 1},
        .output = {.width = 24, .height = 24}};
    s.render.output.only = light_part::caustic;
    const double known = 0.5 / M_PI * 4 * std::cos(std::atan(0.5));
    // The sum of squared errors of the pixels beside the rim.
    const auto error = [&](radius_kind kind) {
        auto settings = s.render;
        settings.estimate.radii = kind;
        settings.output.passes = 16;
        const auto drawn = this->picture(s, settings);
        double squares = 0;
        for (std::uint32_t y = 0; y < 24; ++y)
            for (std::uint32_t x = 0; x < 24; ++x) {
                const dvec3 d = through_pixel(s.camera, settings.output, x, y);
                const dvec3 p = s.camera.position + d * (0.95 / d.y);
                const double inside = std::min(0.4 - std::abs(p.x - 0.5), 0.4 - std::abs(p.z)); // of the square
                if (std::abs(inside) < 0.05)
                    continue; // the rim runs through some of its pixels
                const double e = static_cast<double>(drawn.pixels[y * 24 + x].x) - (inside > 0 ? known : 0);
                squares += e * e / (known * known);
            }
        return squares;
    };
    const double fixed = error(radius_kind::per_pass), shrunk = error(radius_kind::shrinking);
    EXPECT_GT(fixed, 5);
    EXPECT_LT(shrunk, 0.6 * fixed);
}

} // namespace photongrid::testing
