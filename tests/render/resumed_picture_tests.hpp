// Pictures that go on from a saved state, and pictures of several passes.
#pragma once

#include "progressive.hpp"

namespace photongrid::testing {

TYPED_TEST_P(progressive, a_picture_goes_on_from_its_state)
{
    using ms = typename TestFixture::ms;
    auto s = this->small_scene();
    s.render.view.spp = 4;
    s.render.output.aov = true;
    s.render.output.report_bias = bias_report::yes;
    const auto expected = this->whole(s, s.render);
    render_state state;
    uint least = 1;
    int lives = 0;
    for (; state.film.passes() == 0; ++lives) {
        ASSERT_LT(lives, 20);
        typename TestFixture::loop drawing(this->b());
        drawing.start(s, s.render);
        if (!state.empty())
            drawing.resume(state);
        while (!drawing.finished() && drawing.state().pass.rays < least)
            drawing.step(ms(0));
        state = drawing.state();
        EXPECT_TRUE(drawing.finished() || state.pass.rays >= least);
        least = state.pass.rays + 3; // of 16: four ways through the glass, four samples
        if (drawing.finished()) {
            EXPECT_TRUE(same_bytes(drawing.picture(), expected));
            EXPECT_EQ(drawing.picture().layers.relative_error, expected.layers.relative_error);
            EXPECT_EQ(drawing.picture().layers.bias, expected.layers.bias);
        }
    }
    EXPECT_GE(lives, 4);
    EXPECT_TRUE(std::any_of(expected.layers.bias.begin(), expected.layers.bias.end(), [](float b) { return b != 0; }));

    typename TestFixture::loop other(this->b());
    auto larger = s.render, without_layers = s.render, without_biases = s.render;
    without_biases.output.report_bias = bias_report::no;
    larger.output.width += 1;
    without_layers.output.aov = false;
    for (const auto& settings : {larger, without_layers, without_biases}) {
        other.start(s, settings);
        EXPECT_THROW(other.resume(state), std::invalid_argument);
        EXPECT_THROW(other.resume({{}, {0, 0, 1, {}, {}}}), std::invalid_argument);
        EXPECT_FALSE(other.finished());
    }
    other.start(s, s.render);
    const auto n = expected.pixels.size();
    const std::vector<glm::vec4> some(n);
    other.resume({{}, {0, 0, 17, {}, {some, some, some, {some, some, some}}}}); // more rays than there are
    EXPECT_THROW(other.step(), std::invalid_argument);
}

/// A scene of 48 x 40 pixels in five bands of 8 rows.
inline scene in_bands(scene s)
{
    s.render.view.spp = 2;
    s.render.output.passes = 2;
    s.render.output.aov = true;
    s.render.output.band = 48 * 9 + 5;
    return s;
}
/// The same picture, but for the order in which cpu adds up.
inline void expect_same_light(const image& picture, const image& expected)
{
    EXPECT_LE(relative_mse(picture, expected), 1e-12);
    EXPECT_EQ(picture.layers.count, expected.layers.count);
}

TYPED_TEST_P(progressive, bands_of_rows_make_the_same_picture)
{
    const auto s = in_bands(this->small_scene());
    auto at_once = s.render;
    at_once.output.band = 48 * 40;
    const auto expected = render(this->b(), s, at_once);
    const auto drawn = render(this->b(), s, s.render);
    expect_same_light(drawn.picture, expected.picture);
    EXPECT_EQ(drawn.stats.estimate.points, expected.stats.estimate.points);
    EXPECT_NEAR(drawn.stats.estimate.mean_radius, expected.stats.estimate.mean_radius, 1e-9);
    EXPECT_EQ(drawn.stats.photons.emitted, expected.stats.photons.emitted);
    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render); // with previews
    drawing.step();
    expect_same_light(drawing.picture(), expected.picture);
}

TYPED_TEST_P(progressive, bands_of_rows_are_shown_from_the_top)
{
    using ms = typename TestFixture::ms;
    const auto s = in_bands(this->small_scene());
    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render, {.enabled = false}); // black below
    for (uint band = 1; band < 5; ++band) {
        while (drawing.pictures() < band)
            drawing.step(ms(0));
        const auto part = drawing.picture();
        EXPECT_GT(part.pixels[48 * (8 * band - 5) + 20].x, 0.0f) << band;
        EXPECT_EQ(part.pixels[48 * 8 * band + 20].x, 0.0f) << band;
        EXPECT_GE(drawing.progress().fraction, 8 * band / 40.0);
        EXPECT_LE(drawing.progress().unfinished, 48u * (40 - 8 * band));
    }
    drawing.step();
    expect_same_light(drawing.picture(), this->whole(s, s.render));
}

TYPED_TEST_P(progressive, bands_of_rows_go_on_from_their_states)
{
    using ms = typename TestFixture::ms;
    const auto s = in_bands(this->small_scene());
    render_state state;
    int lives = 0;
    for (bool finished = false; !finished; ++lives) {
        ASSERT_LT(lives, 100);
        typename TestFixture::loop next(this->b());
        next.start(s, s.render);
        if (!state.empty())
            next.resume(state);
        const auto goal = state;
        while (!next.finished()) {
            next.step(ms(0));
            state = next.state();
            if (state.film.passes() != goal.film.passes() || state.pass.rows != goal.pass.rows
                || state.pass.rays > goal.pass.rays + 2)
                break;
        }
        finished = next.finished();
        if (finished)
            expect_same_light(next.picture(), this->whole(s, s.render));
    }
    EXPECT_GE(lives, 10);
    auto other_bands = s.render;
    other_bands.output.aov = false;
    other_bands.output.band = 48 * 16;
    typename TestFixture::loop other(this->b());
    other.start(s, other_bands);
    EXPECT_THROW(other.resume({{}, {0, 8, 0, {std::vector<glm::vec4>(48 * 8), {}, {}}, {}}}), std::invalid_argument);
}

/// A finished picture is shown; one with passes that the picture does not have, or with more, would never end.
TYPED_TEST_P(progressive, a_state_of_more_passes_is_refused)
{
    auto s = this->small_scene();
    s.render.output.passes = 3;
    typename TestFixture::loop drawing(this->b());
    EXPECT_THROW(drawing.resume({}), std::logic_error) << "nothing was started";
    drawing.start(s, s.render, {.enabled = false});
    drawing.step();
    const auto three = drawing.state();
    auto fewer = s.render;
    fewer.output.passes = 2;
    typename TestFixture::loop other(this->b());
    other.start(s, fewer);
    EXPECT_THROW(other.resume(three), std::invalid_argument);
    EXPECT_FALSE(other.finished());
    EXPECT_TRUE(other.step()) << "the refused state left no trace";
    EXPECT_TRUE(same_bytes(other.picture(), this->whole(s, fewer)));
    other.start(s, s.render);
    other.resume(three);
    EXPECT_TRUE(other.finished());
    EXPECT_EQ(other.pictures(), 1u);
    EXPECT_TRUE(same_bytes(other.picture(), drawing.picture()));
}

TYPED_TEST_P(progressive, passes_add_up_in_any_order)
{
    using ms = typename TestFixture::ms;
    auto s = this->small_scene();
    s.render.map.photons = 1000;
    s.render.output.passes = 4;
    s.render.output.aov = true;
    const auto expected = this->whole(s, s.render);
    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render);
    std::uint64_t seen = 0;
    while (!drawing.finished()) {
        drawing.step(ms(0));
        EXPECT_GE(drawing.pictures(), seen);
        seen = drawing.pictures();
    }
    EXPECT_TRUE(same_bytes(drawing.picture(), expected));
    EXPECT_EQ(drawing.picture().layers.noise, expected.layers.noise);
    EXPECT_EQ(drawing.progress().passes, 4u);
    EXPECT_EQ(drawing.stats().photons.stored, 4000u);
    expect_an_exact_account(drawing.stats().photons, 4000);
    // Another view begins with the pass whose map is there: the last one.
    auto moved = s;
    moved.camera.position.x += 0.1;
    const auto maps = drawing.maps();
    const auto bounces = this->passes("bounce_photon");
    drawing.start(moved, s.render, {.enabled = false});
    while (drawing.state().film.passes() == 0)
        drawing.step(ms(0));
    EXPECT_TRUE(drawing.state().film.holds(3));
    EXPECT_EQ(this->passes("bounce_photon"), bounces);
    drawing.step();
    EXPECT_EQ(drawing.maps(), maps + 3);
    EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(moved, s.render)));
    // From states in the middle, too.
    render_state state;
    for (int lives = 0; state.film.passes() < 4; ++lives) {
        ASSERT_LT(lives, 40);
        typename TestFixture::loop next(this->b());
        next.start(s, s.render);
        if (!state.empty())
            next.resume(state);
        const auto before = next.state();
        while (!next.finished() && next.state().film.passes() == before.film.passes()
            && next.state().pass.rays < before.pass.rays + 3)
            next.step(ms(0));
        state = next.state();
        if (next.finished()) {
            EXPECT_TRUE(same_bytes(next.picture(), expected));
        }
    }
    // Each pass has photons, eye rays and shadow rays of its own.
    for (const auto only : {light_part::direct, light_part::indirect}) {
        auto a = settings_of_pass(s.render, 0), b = settings_of_pass(s.render, 1);
        a.output.only = b.output.only = only;
        a.output.passes = b.output.passes = 1;
        EXPECT_GT(relative_mse(this->whole(s, a), this->whole(s, b)), 1e-5);
    }
}

} // namespace photongrid::testing
