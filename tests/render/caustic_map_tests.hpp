// Caustic photons in a map of their own, and guided emission: known light, accounts, parts of the light.
#pragma once

#include "final_gather_tests.hpp"
#include "photon_account_tests.hpp"

namespace photongrid::testing {

inline render_settings with_caustic_map(render_settings s, std::uint32_t photons, std::uint32_t k = 50)
{
    s.map.caustic_photons = photons;
    s.estimate.caustic_k = k;
    return s;
}

TYPED_TEST_P(pictures, caustic_photons_of_their_own_have_the_power_that_optics_predicts)
{
    auto& b = this->b();
    const ball_over_floor ball;
    const auto s = ball.as_scene();
    double paths[2] = {};
    for (const auto emission : {photon_emission::power, photon_emission::guided}) {
        auto settings = with_caustic_map(s.render, 20000);
        settings.map.emission = emission;
        const auto built = build_map(b, s, settings);
        ASSERT_EQ(built.lights.size(), 2u);
        const auto& p = built.caustics().photons;
        // The ball is 1.4 % of all directions, so that even emission ends with fewer.
        if (emission == photon_emission::guided)
            EXPECT_EQ(p.size(), 20000u);
        else
            EXPECT_NEAR(static_cast<double>(p.size()), 0.01406 * 20000 * most_paths_per_caustic_photon, 500);
        this->expect_focus(p, built.scene().layout.center, ball);
        const auto counted = count_photons(b, built.lights.back().trace);
        expect_an_exact_account(counted, p.size());
        EXPECT_EQ(counted.left_to_caustics, 0u);
        paths[emission == photon_emission::guided] = static_cast<double>(counted.emitted);
    }
    EXPECT_GT(paths[0], 8 * paths[1]); // the ball fills 2 % of the directions
}

TYPED_TEST_P(pictures, the_account_is_exact_with_a_map_of_caustic_photons)
{
    for (const auto& s : {small_cornell(), all_shapes()})
        for (const bool gathers : {false, true}) {
            auto settings = with_caustic_map(gathers ? gathering(s.render, 1) : s.render, 3000);
            settings.map.photons = 5000;
            settings.map.photon_depth = 5;
            settings.output.width = settings.output.height = 8;
            render_stats stats;
            (void)this->picture(s, settings, &stats);
            expect_an_exact_account(stats.photons, stats.photons.stored);
            EXPECT_LE(stats.photons.stored, 8000u);
            EXPECT_GT(stats.photons.stored, gathers ? 7999u : 4000u); // other photons end after 2 paths each
            EXPECT_GT(stats.photons.cut_off, 0u);
            EXPECT_EQ(stats.photons.left_to_caustics > 0, !gathers); // a gather's photons have caustics, too
        }
}

/// A bulb over a small mirror: few photons are on a second diffuse surface, and few paths are spent on them.
TYPED_TEST_P(pictures, maps_end_with_fewer_photons_rather_than_trace_for_ever)
{
    auto s = bulb_over_a_floor();
    s.materials.push_back({"mirror", material_kind::mirror, dvec3(1)});
    s.spheres.push_back({{0.5, 0.05, 0}, 0.03, 1});
    auto settings = with_caustic_map(s.render, 4000);
    settings.map.photons = 2000;
    settings.map.emission = photon_emission::power;
    render_stats stats;
    (void)this->picture(s, settings, &stats);
    expect_an_exact_account(stats.photons, stats.photons.stored);
    EXPECT_GT(stats.photons.stored, 0u);
    EXPECT_LT(stats.photons.stored, 2000u);
    EXPECT_EQ(stats.photons.emitted, 2 * 2000u + 32 * 4000u);
}

TYPED_TEST_P(pictures, the_parts_of_a_picture_with_a_map_of_caustic_photons_add_up)
{
    const auto s = small_cornell();
    auto settings = with_caustic_map(s.render, 4000);
    settings.output.width = settings.output.height = 24;
    const auto all = this->picture(s, settings);
    std::vector<dvec3> sum(all.pixels.size(), dvec3(0));
    double brightest = 0;
    for (const auto part : {light_part::direct, light_part::caustic, light_part::indirect}) {
        settings.output.only = part;
        const auto drawn = this->picture(s, settings);
        double most = 0;
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += dvec3(drawn.pixels[i]);
            most = std::max(most, static_cast<double>(drawn.pixels[i].y));
        }
        EXPECT_GT(most, 0) << static_cast<int>(part);
        brightest = std::max(brightest, most);
    }
    for (std::size_t i = 0; i < sum.size(); ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(sum[i][c], static_cast<double>(all.pixels[i][c]), 1e-5 * brightest) << i;
}

/// The same light with or without a guide, from a map of all photons, and with the radii of another map. All estimates
/// are of the same radius, so that their blur is the same.
TYPED_TEST_P(pictures, a_map_of_caustic_photons_brings_the_light_of_the_map_of_all)
{
    auto s = small_cornell();
    s.render.output.width = s.render.output.height = 16;
    s.render.estimate.search = search_kind::fixed_radius;
    s.render.estimate.max_radius = 0.1;
    s.render.map.emission = photon_emission::power;
    s.render.map.photons = 40000;
    s.render.view.spp = 4;
    const auto part = [&](render_settings settings, light_part only) {
        settings.output.only = only;
        return mean_of(this->picture(s, settings));
    };
    const auto own = with_caustic_map(s.render, 20000);
    auto guided = own, given = own;
    guided.map.emission = photon_emission::guided;
    given.estimate.radii = radius_kind::shrinking;
    for (const auto only : {light_part::caustic, light_part::indirect}) {
        const auto expected = part(own, only);
        for (const auto& mean : {part(guided, only), part(given, only), part(s.render, only)})
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(mean[c], expected[c], (only == light_part::caustic ? 0.06 : 0.03) * expected[c])
                    << static_cast<int>(only) << " channel " << c;
    }
}

TYPED_TEST_P(pictures, maps_of_caustic_photons_equal_serials)
{
    auto& b = this->b();
    if (!b.caps().exact_division || !b.caps().exact_sqrt)
        GTEST_SKIP() << "this device rounds division or square root loosely";
    serial_backend serial;
    for (const auto& s : {small_cornell(), all_shapes()})
        for (const bool gathers : {false, true}) {
            auto settings = with_caustic_map(gathers ? gathering(s.render, 2) : s.render, 2000);
            settings.map.photons /= 4;
            settings.output.width = 24;
            settings.output.height = 18;
            settings.output.aov = true;
            const auto mine = render(b, s, settings), theirs = render(serial, s, settings);
            EXPECT_LE(relative_mse(mine.picture, theirs.picture), 1e-9) << s.name;
            EXPECT_EQ(mine.stats.photons.emitted, theirs.stats.photons.emitted);
            EXPECT_EQ(mine.stats.photons.left_to_caustics, theirs.stats.photons.left_to_caustics);
            for (std::size_t i = 0; i < mine.picture.layers.relative_error.size(); ++i)
                ASSERT_NEAR(mine.picture.layers.relative_error[i], theirs.picture.layers.relative_error[i], 1e-4) << i;
        }
}

/// In a routed map of few cells a photon that has a slot would stand for more than an estimate seeks, and most of a
/// caustic's light would be lost.
TYPED_TEST_P(pictures, maps_of_caustic_photons_are_sorted_where_others_are_routed)
{
    const auto s = small_cornell();
    auto sorted = with_caustic_map(s.render, 2000);
    sorted.output.only = light_part::caustic;
    sorted.output.width = 24;
    sorted.output.height = 18;
    sorted.map.use_grid({2, 2, 2});
    sorted.map.builder = map_builder::sort;
    auto routed = sorted;
    routed.map.builder = map_builder::route;
    routed.map.slots = 1;
    EXPECT_TRUE(same_bytes(this->picture(s, routed), this->picture(s, sorted)));
}

/// Step by step, with previews, and from a pass in the middle on, a picture has the same bytes.
TYPED_TEST_P(pictures, maps_of_caustic_photons_do_not_depend_on_how_passes_are_run)
{
    auto& b = this->b();
    const auto s = small_cornell();
    auto settings = with_caustic_map(s.render, 2000);
    settings.map.photons /= 4;
    settings.output.width = 24;
    settings.output.height = 18;
    settings.output.passes = 3;
    const auto whole = this->expect_the_same_however_it_is_run(s, settings);
    progressive_render<typename TestFixture::B> drawing(b);
    drawing.start(s, settings);
    while (!drawing.step(renderer::milliseconds(0))) {}
    EXPECT_TRUE(same_bytes(drawing.picture(), whole));
}

TYPED_TEST_P(pictures, a_view_of_a_map_without_its_caustics_is_refused)
{
    auto& b = this->b();
    const auto s = small_cornell();
    const auto apart = with_caustic_map(s.render, 1000);
    const auto plain = build_map(b, s, s.render), with = build_map(b, s, apart);
    EXPECT_FALSE(same_map(s.render, apart));
    EXPECT_THROW((void)draw(b, plain, s.camera, apart), std::invalid_argument);
    EXPECT_THROW((void)draw(b, with, s.camera, s.render), std::invalid_argument);
    EXPECT_NO_THROW((void)draw(b, with, s.camera, apart));
    // A scene without mirrors or glass has no caustics and needs no map of them.
    const auto dull = bulb_over_a_floor();
    const auto none = build_map(b, dull, with_caustic_map(dull.render, 1000));
    EXPECT_EQ(none.lights.size(), 1u);
    EXPECT_NO_THROW((void)draw(b, none, dull.camera, with_caustic_map(dull.render, 1000)));
}

} // namespace photongrid::testing
