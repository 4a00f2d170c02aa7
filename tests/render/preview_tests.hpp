// Previews: as bright as the picture, left out when no longer wanted, and followed by the bytes of render().
#pragma once

#include "progressive.hpp"
#include <photongrid/io/scene_file.hpp>

namespace photongrid::testing {

/// Mean over pixels and channels of the displayed values: lamps are white, however bright.
inline double brightness(const image& im)
{
    double sum = 0;
    for (const auto& p : im.pixels)
        for (int c = 0; c < 3; ++c)
            sum += std::min(static_cast<double>(p[c]), 1.0);
    return sum / static_cast<double>(3 * im.pixels.size());
}

TYPED_TEST_P(progressive, ends_with_the_bytes_of_render)
{
    using ms = typename TestFixture::ms;
    auto s = this->small_scene();
    auto paper = as_paper(s.render), several = s.render, fixed = s.render, layers = s.render, part = s.render;
    several.view.spp = 3;
    fixed.estimate.search = search_kind::fixed_radius;
    fixed.map.builder = map_builder::route;
    layers.output.aov = true;
    part.output.only = light_part::caustic;
    for (const auto& settings : {s.render, paper, several, fixed, layers, part}) {
        const auto expected = this->whole(s, settings);
        for (const double target : {1e-6, 1e9}) { // all previews, the first from an early map; as few as there can be
            typename TestFixture::loop drawing(this->b());
            drawing.start(s, settings, {.target_ms = target});
            std::uint64_t seen = 0;
            while (!drawing.finished()) {
                drawing.step(ms(0));
                ASSERT_GE(drawing.pictures(), seen);
                if (drawing.pictures() > seen) {
                    const auto shown = drawing.picture();
                    ASSERT_EQ(shown.width, settings.output.width);
                    ASSERT_EQ(shown.pixels.size(), expected.pixels.size());
                }
                seen = drawing.pictures();
            }
            EXPECT_TRUE(same_bytes(drawing.picture(), expected)) << "target " << target;
            EXPECT_EQ(drawing.picture().layers.radius, expected.layers.radius);
            EXPECT_EQ(drawing.progress().stage, "finished");
            EXPECT_EQ(drawing.progress().unfinished, 0u);
            expect_an_exact_account(drawing.stats().photons, settings.map.photons);
            if (target < 1) {
                EXPECT_EQ(drawing.maps(), 2u);
                EXPECT_GE(seen, 3u);
            } else {
                EXPECT_EQ(drawing.maps(), 1u);
            }
        }
        typename TestFixture::loop at_once(this->b());
        at_once.start(s, settings, {.enabled = false});
        EXPECT_TRUE(at_once.step());
        EXPECT_TRUE(same_bytes(at_once.picture(), expected));
    }
}

TYPED_TEST_P(progressive, one_preview_is_drawn_where_no_more_are_wanted)
{
    const auto s = this->small_scene();
    const auto shown_with = [&](const preview_settings& previews) {
        typename TestFixture::loop drawing(this->b());
        drawing.start(s, s.render, previews);
        return this->pictures_of(drawing);
    };
    for (const double target : {1e-6, 0.1}) { // from an early map, or from that of the picture
        const auto without = shown_with({.enabled = false}),
                   one = shown_with({.target_ms = target, .only_first = true});
        ASSERT_EQ(one.size(), without.size() + 1) << target;
        EXPECT_GT(shown_with({.target_ms = target}).size(), one.size()) << target;
        EXPECT_NEAR(brightness(one.front()), brightness(one.back()), 0.15 * brightness(one.back())) << target;
        EXPECT_TRUE(same_bytes(one.back(), without.back()));
    }
}

TYPED_TEST_P(progressive, previews_are_as_bright_as_the_picture)
{
    auto s = this->small_scene();
    s.render.output.width = s.render.output.height = 128;
    s.render.estimate.k = 128;
    s.render.map.photons = 16000;
    auto several = s.render;
    several.view.spp = 3;
    for (const auto& settings : {s.render, as_paper(s.render), several}) {
        typename TestFixture::loop drawing(this->b());
        drawing.start(s, settings, {.target_ms = 1e-6});
        const auto shown = this->pictures_of(drawing);
        // The paper's search has previews of larger pixels only, and then shows its running estimate.
        const bool previews_only = settings.estimate.search == search_kind::at_least_k
            && !knn_search<typename TestFixture::B>::shows_running_estimate(as_paper(knn_settings{}));
        ASSERT_GE(shown.size(), previews_only ? 3u : 5u);
        const double expected = brightness(shown.back());
        for (std::size_t i = 0; i + 1 < shown.size(); ++i)
            EXPECT_NEAR(brightness(shown[i]), expected, (i == 0 ? 0.06 : 0.04) * expected)
                << "picture " << i << " of " << shown.size();
        // Refined in place: each is nearer to the last one than the one two before, up to noise.
        for (std::size_t i = 2; i + 1 < shown.size(); ++i)
            EXPECT_LT(relative_mse(shown[i], shown.back()), 1.1 * relative_mse(shown[i - 2], shown.back()))
                << "picture " << i;
    }
}

/// The paper's running estimate (2.4, figure 8): in every scene each picture is nearer to the last one than the one
/// before, on every backend, and the last one is the picture.
TYPED_TEST_P(progressive, running_estimates_approach_the_picture)
{
    for (const auto* name : {"glass_ball", "ring", "cornell_box", "cornell_blocks"}) {
        SCOPED_TRACE(name);
        auto s = read_scene(std::string(PHOTONGRID_SCENES) + "/" + name + ".json");
        s.render = as_paper(s.render);
        s.render.output.width = 48;
        s.render.output.height = 36;
        s.render.map.photons = std::min(s.render.map.photons, 8000u);
        s.render.estimate.k = std::min(s.render.estimate.k, 100u);
        s.render.view.light_samples = 4;
        typename TestFixture::loop drawing(this->b());
        drawing.start(s, s.render, {.running_estimates = true});
        const auto shown = this->pictures_of(drawing);
        ASSERT_GE(shown.size(), 4u);
        EXPECT_TRUE(same_bytes(shown.back(), this->whole(s, s.render)));
        EXPECT_GT(relative_mse(shown.front(), shown.back()), 1e-4) << "there was something to see";
        for (std::size_t i = 1; i < shown.size(); ++i)
            EXPECT_LE(relative_mse(shown[i], shown.back()), relative_mse(shown[i - 1], shown.back()))
                << "picture " << i << " of " << shown.size();
    }
}

TYPED_TEST_P(progressive, previews_that_are_no_longer_wanted_are_not_drawn)
{
    using ms = typename TestFixture::ms;
    const auto s = this->small_scene();
    const auto expected = this->whole(s, s.render);
    for (int steps = 1; steps < 12; ++steps) { // into the early map, the preview from it, the map after it
        typename TestFixture::loop drawing(this->b());
        drawing.start(s, s.render, {.target_ms = 1e-6});
        for (int i = 0; i < steps; ++i)
            drawing.step(ms(0));
        drawing.start(s, s.render, {.enabled = false});
        EXPECT_TRUE(drawing.step());
        EXPECT_EQ(drawing.pictures(), 1u) << "after " << steps << " steps";
        EXPECT_LE(drawing.maps(), 2u);
        EXPECT_TRUE(same_bytes(drawing.picture(), expected)) << "after " << steps << " steps";
    }
}

} // namespace photongrid::testing
