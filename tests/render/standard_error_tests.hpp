// The layer `relative_error` of pictures is the spread that their irradiance has from seed to seed: for traced photons,
// sorted and routed, in one pass and in several.
#pragma once

#include "material_statistics.hpp"

namespace photongrid::testing {

/// Over `seeds` pictures and the pixels that show a white surface: the mean of the reported relative error over the
/// spread.
inline double reported_over_spread(scene s, const render_settings& settings, int seeds)
{
    s.render = settings;
    s.render.output.only = light_part::indirect;
    s.render.output.aov = true;
    const auto seen = materials_seen(s, s.render.output.width, s.render.output.height);
    struct sums {
        double light = 0, squares = 0, reported = 0;
    };
    std::vector<sums> pixels(seen.size());
    serial_backend serial;
    for (int seed = 0; seed < seeds; ++seed) {
        s.render.seed = 300 + static_cast<std::uint32_t>(seed);
        const auto im = render(serial, s, s.render).picture;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const double light = static_cast<double>(im.pixels[i].x + im.pixels[i].y + im.pixels[i].z);
            pixels[i].light += light;
            pixels[i].squares += light * light;
            pixels[i].reported += static_cast<double>(im.layers.relative_error[i]);
        }
    }
    double ratios = 0;
    int white = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const auto& p = pixels[i];
        if (seen[i] != 0 || p.light == 0)
            continue;
        const double mean = p.light / seeds, spread = std::sqrt((p.squares - seeds * mean * mean) / (seeds - 1)) / mean;
        ratios += p.reported / seeds / spread;
        ++white;
    }
    EXPECT_GT(white, 40);
    return ratios / white;
}

/// A close view of a floor that is lit indirectly: the photons and eye rays of a pixel see the same light.
inline scene close_floor()
{
    auto s = small_cornell();
    s.spheres.clear(); // their caustics are few photons of much power
    s.camera = {{0.5, 0.9, 0.5}, {0.4, 0, 0.6}, {0, 0, 1}, 5};
    s.render.map.photons = 3000;
    s.render.estimate.k = 50;
    s.render.estimate.max_radius = 1;
    s.render.output.width = s.render.output.height = 12;
    return s;
}

TEST(standard_errors, are_no_more_than_a_third_off_the_spread_of_traced_maps)
{
    // The spread of n pictures is known to 1 / sqrt(2 n) of itself. The pixels' estimates share photons, so that their
    // mean is hardly better known than one of them.
    constexpr int seeds = 60;
    const auto s = close_floor();
    const double ratio = reported_over_spread(s, s.render, seeds);
    std::printf("sorted, %d seeds: reported over spread %.3f\n", seeds, ratio);
    EXPECT_NEAR(ratio, 1, 4 / std::sqrt(2.0 * seeds));
}

TEST(standard_errors, long_are_the_spread_of_traced_maps)
{
    const auto s = close_floor();
    auto settings = s.render;
    const auto check = [&](const char* what) {
        const double ratio = reported_over_spread(s, settings, 200);
        std::printf("%s: reported over spread %.3f\n", what, ratio);
        EXPECT_NEAR(ratio, 1, 0.1) << what;
    };
    check("sorted");
    settings.output.passes = 4;
    check("sorted, 4 passes");
    settings.output.passes = 1;
    settings.map.builder = map_builder::route;
    settings.map.slots = 16; // all photons are kept; where they are not: estimator_statistics.cpp
    check("routed");
    settings.map.builder = map_builder::sort;
    settings.estimate.search = search_kind::fixed_radius;
    settings.estimate.max_radius = 0.25;
    check("sorted, fixed radius");
}

} // namespace photongrid::testing
