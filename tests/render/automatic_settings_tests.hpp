// Settings that the renderer chooses.
#pragma once

#include "progressive.hpp"

#include <photongrid/render/draw.hpp>

namespace photongrid::testing {

TYPED_TEST_P(progressive, automatic_settings_become_numbers)
{
    using ms = typename TestFixture::ms;
    auto s = this->small_scene();
    s.render = automatic_settings();
    s.render.output.width = 24;
    s.render.output.height = 20;
    s.render.output.passes = 2;
    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render);
    EXPECT_THROW(drawing.resume({}), std::logic_error);
    bool pilot_shown = false;
    while (is_automatic(drawing.settings())) {
        drawing.step(ms(0));
        pilot_shown |= drawing.progress().stage == "choose_settings";
    }
    EXPECT_TRUE(pilot_shown);
    EXPECT_EQ(drawing.pictures(), 0u);
    const auto numbers = drawing.settings();
    EXPECT_NO_THROW(check_numbers(numbers));
    EXPECT_EQ(numbers.output.passes, 2u);
    EXPECT_TRUE(drawing.stats().pilot.has_value());

    drawing.resume({}); // a state without work
    drawing.step();
    EXPECT_TRUE(drawing.finished());
    EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(s, numbers)));
    EXPECT_EQ(chosen_settings(drawing, s, s.render), numbers) << "the same scene again";
    EXPECT_FALSE(drawing.finished());
}

TYPED_TEST_P(progressive, an_automatic_number_of_passes_is_drawn)
{
    auto s = this->small_scene();
    s.render.output.width = 12;
    s.render.output.height = 10;
    s.render.map.photons = 1000;
    s.render.output.passes = automatic_number;
    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render);
    drawing.step();
    EXPECT_GE(drawing.settings().output.passes, 8u);
    EXPECT_EQ(drawing.stats().end.passes, drawing.settings().output.passes);
}

TYPED_TEST_P(progressive, an_automatic_radius_needs_no_pilot)
{
    auto s = this->small_scene();
    s.render.estimate.max_radius = automatic_length;
    typename TestFixture::loop drawing(this->b());
    const auto numbers = chosen_settings(drawing, s, s.render);
    EXPECT_FALSE(drawing.stats().pilot.has_value());
    const auto box = bounds_of(s);
    EXPECT_NEAR(
        numbers.estimate.max_radius, 0.1 * glm::length(box.high - box.low), 0.03 * glm::length(box.high - box.low));
    drawing.step();
    EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(s, numbers)));
}

TYPED_TEST_P(progressive, a_pilot_traces_the_paths_of_the_picture)
{
    // Most paths store no photon: what the sun brings to the ground it takes away again.
    auto s = this->small_scene();
    s.polygons = {{{{-9, 0, -9}, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}}, 0}};
    s.spheres = {{{0.5, 0.4, 0.5}, 0.4, 0}};
    s.rectangle_lights.clear();
    s.directional_lights = {{"sun", {0.3, -1, 0.2}, dvec3(2)}};
    s.render = automatic_settings();
    s.render.output.width = s.render.output.height = 16;
    s.render.output.passes = 1;
    s.render.map.photons = 4096; // as many as the pilot's, with the same guide
    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render);
    drawing.step();
    const auto& photons = drawing.stats().photons;
    ASSERT_GT(photons.stored, 0u);
    const double paths
        = static_cast<double>(photons.emitted + photons.diffuse_hits) / static_cast<double>(photons.asked);
    EXPECT_GT(paths, 8);
    EXPECT_NEAR(drawing.stats().pilot->maps[1].segments, paths, 0.1 * paths);
}

TYPED_TEST_P(progressive, maps_and_views_need_numbers)
{
    auto s = this->small_scene();
    const auto built = build_map(this->b(), s, s.render);
    s.render.map.photons = automatic_number;
    EXPECT_THROW((void)build_map(this->b(), s, s.render), std::invalid_argument);
    EXPECT_THROW((void)draw(this->b(), built, s.camera, s.render), std::invalid_argument);
}

} // namespace photongrid::testing
