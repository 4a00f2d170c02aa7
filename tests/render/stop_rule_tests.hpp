// Pictures that a stop rule ends.
#pragma once

#include "progressive.hpp"

namespace photongrid::testing {

/// As many passes give the same bytes, however the picture came about.
TYPED_TEST_P(progressive, a_picture_that_its_error_ends_has_the_bytes_of_as_many_passes)
{
    using ms = typename TestFixture::ms;
    auto s = this->small_scene();
    s.render.output.width = 24;
    s.render.output.height = 20;
    s.render.map.photons = 1000;
    s.render.estimate.k = 100;
    s.render.view.spp = 1;
    s.render.output.until_error = 0.3;
    const auto drawn = render(this->b(), s, s.render);
    const auto& end = drawn.stats.end;
    EXPECT_EQ(end.by, ended_by::error);
    EXPECT_LE(end.error, 0.3);
    ASSERT_GE(end.passes, 5u);
    ASSERT_LE(end.passes, 60u);
    auto counted = s.render;
    counted.output.until_error = 0;
    counted.output.passes = end.passes;
    counted.output.report_bias = bias_report::yes;
    const auto expected = render(this->b(), s, counted);
    EXPECT_TRUE(same_bytes(drawn.picture, expected.picture));
    EXPECT_EQ(expected.stats.end.by, ended_by::passes);
    EXPECT_EQ(expected.stats.end.error, end.error);

    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render);
    double whole = 0;
    while (!drawing.finished()) {
        drawing.step(ms(0));
        whole = drawing.progress().whole;
        EXPECT_GE(whole, 0);
        EXPECT_LE(whole, 1);
        EXPECT_GE(drawing.progress().seconds_left, 0);
    }
    EXPECT_EQ(whole, 1);
    EXPECT_EQ(drawing.progress().seconds_left, 0);
    EXPECT_EQ(drawing.stats().end.passes, end.passes);
    EXPECT_EQ(drawing.stats().end.by, ended_by::error);
    EXPECT_TRUE(same_bytes(drawing.picture(), expected.picture));
    const auto maps = drawing.maps();
    EXPECT_LE(maps, end.passes + 1u) << "no map for a pass that is not drawn";

    // Another view, while the map of the last pass is there: the same passes as if it were not.
    auto moved = s;
    moved.camera.position.x += 0.1;
    for (const bool previews : {true, false}) {
        drawing.start(moved, s.render, {.enabled = previews, .target_ms = 1e-6}); // so short that there are previews
        if (const auto before = drawing.maps(); previews) {
            while (drawing.pictures() == 0)
                drawing.step(ms(0));
            EXPECT_EQ(drawing.maps(), before) << "the first preview has the map that is there";
        }
        drawing.step();
        const auto alone = render(this->b(), moved, s.render);
        EXPECT_EQ(drawing.stats().end.passes, alone.stats.end.passes);
        EXPECT_TRUE(same_bytes(drawing.picture(), alone.picture));
    }

    // From states in the middle, the last of them of a picture that a larger error ended.
    auto larger = s.render;
    larger.output.until_error = 0.5;
    drawing.start(s, larger);
    while (drawing.progress().passes < 2)
        drawing.step(ms(0));
    drawing.step(ms(0));
    auto state = drawing.state();
    for (const auto& settings : {larger, s.render}) {
        typename TestFixture::loop next(this->b());
        next.start(s, settings);
        next.resume(state);
        next.step();
        state = next.state();
        EXPECT_EQ(next.stats().end.by, ended_by::error);
        EXPECT_LE(next.stats().end.error, settings.output.until_error);
        if (settings == larger)
            EXPECT_LT(next.stats().end.passes, end.passes);
        else
            EXPECT_TRUE(same_bytes(next.picture(), expected.picture));
    }
    // One with more passes than needed is finished.
    drawing.start(s, larger);
    drawing.resume(state);
    EXPECT_TRUE(drawing.finished());
    EXPECT_TRUE(drawing.step());
    EXPECT_TRUE(same_bytes(drawing.picture(), expected.picture));
}

TYPED_TEST_P(progressive, a_picture_that_time_ends_has_the_bytes_of_as_many_passes)
{
    auto s = this->small_scene();
    s.render.output.width = 24;
    s.render.output.height = 20;
    s.render.map.photons = 1000;
    s.render.view.spp = 2;                           // so that one pass has no other eye rays than each of several
    s.render.estimate.radii = radius_kind::per_pass; // nor other radii: on a slow machine the time is that of one pass
    s.render.output.seconds = 0.5;
    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render);
    drawing.step();
    const auto end = drawing.stats().end;
    EXPECT_EQ(end.by, ended_by::seconds);
    if (end.passes > 0) {
        auto counted = s.render;
        counted.output.seconds = 0;
        counted.output.passes = end.passes;
        EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(s, counted)));
    }
    auto state = drawing.state();
    EXPECT_GT(state.seconds, 0);
    // The time of both runs counts.
    drawing.start(s, s.render);
    state.seconds = 1;
    drawing.resume(state);
    EXPECT_EQ(drawing.finished(), end.passes > 0);
    auto longer = s.render;
    longer.output.seconds = 1e6;
    longer.output.passes = end.passes + 2;
    drawing.start(s, longer);
    drawing.resume(state);
    EXPECT_FALSE(drawing.finished());
    drawing.step();
    EXPECT_EQ(drawing.stats().end.by, ended_by::passes);
    longer.output.seconds = 0;
    EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(s, longer)));

    // A first pass that takes an hour: what is there of it.
    auto endless = s;
    endless.render.view.spp = 65536;
    endless.render.output.seconds = 0.05;
    drawing.start(endless, endless.render);
    drawing.step();
    EXPECT_EQ(drawing.stats().end.by, ended_by::seconds);
    EXPECT_EQ(drawing.stats().end.passes, 0u);
    EXPECT_GT(drawing.pictures(), 0u);
    EXPECT_GT(drawing.picture().pixels.size(), 0u);
    state.seconds = -1;
    EXPECT_THROW(drawing.resume(state), std::invalid_argument);
}

} // namespace photongrid::testing
