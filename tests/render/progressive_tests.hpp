// Guarantees of the interactive loop, on any backend: it ends with the bytes of render(), shows pictures of the same
// brightness before, traces photons only when it must, and stops when it is told to. Included by each on_<backend>.cpp.
#pragma once

#include "pictures.hpp"

#include <photongrid/render/progressive_render.hpp>

#include <thread>

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

template <class Tag>
class progressive : public on_backend<Tag> {
protected:
    using B = typename Tag::type;
    using loop = progressive_render<B>;
    using ms = typename loop::milliseconds;

    static scene small_scene()
    {
        auto s = small_cornell();
        s.render.output.width = 48;
        s.render.output.height = 40;
        s.render.map.photons = 4000;
        return s;
    }
    image whole(const scene& s, const render_settings& settings) { return render(this->b(), s, settings).picture; }
    /// Passes of a kernel so far.
    std::uint64_t passes(const char* kernel)
    {
        const auto at = this->b().costs().find(kernel);
        return at == this->b().costs().end() ? std::uint64_t{0} : at->second.passes;
    }
};
TYPED_TEST_SUITE_P(progressive);

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

TYPED_TEST_P(progressive, previews_are_as_bright_as_the_picture)
{
    using ms = typename TestFixture::ms;
    auto s = this->small_scene();
    s.render.output.width = s.render.output.height = 128;
    s.render.estimate.k = 128;
    s.render.map.photons = 16000;
    auto several = s.render;
    several.view.spp = 3;
    for (const auto& settings : {s.render, as_paper(s.render), several}) {
        typename TestFixture::loop drawing(this->b());
        drawing.start(s, settings, {.target_ms = 1e-6});
        std::vector<image> shown;
        for (std::uint64_t seen = 0; !drawing.finished();) {
            drawing.step(ms(0));
            if (drawing.pictures() > seen)
                shown.push_back(drawing.picture());
            seen = drawing.pictures();
        }
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

TYPED_TEST_P(progressive, a_map_serves_until_the_light_changes)
{
    const auto s = this->small_scene();
    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render, {.enabled = false});
    drawing.step();
    const auto rays = this->passes("eye_ray");
    EXPECT_EQ(drawing.maps(), 1u);

    auto moved = s;
    moved.camera.position.x += 0.2;
    moved.name = "another";
    auto settings = s.render;
    settings.estimate.k = 50;
    settings.estimate.filter = filter_kind::cone;
    settings.output.exposure = 1;
    settings.output.width = 32;
    for (const auto& [scene, with] : {std::pair{moved, s.render}, {s, settings}, {moved, settings}}) {
        const auto bounces = this->passes("bounce_photon");
        drawing.start(scene, with, {.target_ms = 1e-6});
        EXPECT_FALSE(drawing.finished());
        EXPECT_EQ(drawing.pictures(), 0u);
        EXPECT_THROW(drawing.picture(), std::logic_error);
        drawing.step();
        EXPECT_TRUE(drawing.finished());
        EXPECT_EQ(drawing.maps(), 1u) << "the photon map was built again";
        EXPECT_EQ(this->passes("bounce_photon"), bounces) << "photons were traced again";
        EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(scene, with)));
    }
    EXPECT_GT(this->passes("eye_ray"), rays);

    auto lit = s;
    lit.rectangle_lights[0].corner.x -= 0.3;
    auto grown = s;
    grown.spheres[0].radius *= 0.5;
    auto painted = s;
    painted.materials[0].reflectance *= 0.5;
    auto more = s.render, seeded = s.render, routed = s.render, finer = s.render, only = s.render, shallow = s.render,
         facing = s.render;
    more.map.photons += 1000;
    seeded.seed = 7;
    routed.map.builder = map_builder::route;
    finer.map.grid *= 2u;
    only.output.only = light_part::caustic;
    shallow.map.photon_depth = 4;
    facing.estimate.leaks.min_cosine = 0.5f;
    for (const auto& [scene, with] : {std::pair{lit, s.render}, {grown, s.render}, {painted, s.render}, {s, more},
             {s, seeded}, {s, routed}, {s, finer}, {s, only}, {s, shallow}, {s, facing}}) {
        drawing.start(s, s.render, {.enabled = false}); // each differs from this in one thing
        drawing.step();
        const auto maps = drawing.maps();
        drawing.start(scene, with, {.enabled = false});
        drawing.step();
        EXPECT_EQ(drawing.maps(), maps + 1) << "the photon map is another scene's";
        EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(scene, with)));
    }
}

TYPED_TEST_P(progressive, a_camera_that_moves_while_photons_are_traced_does_not_begin_them_anew)
{
    using ms = typename TestFixture::ms;
    auto s = this->small_scene();
    s.render.map.photons = 60000; // two batches and more
    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render, {.enabled = false});
    drawing.step(ms(0));
    drawing.step(ms(0));
    for (int i = 0; i < 40 && !drawing.finished(); ++i) {
        s.camera.position.y += 0.001;
        drawing.start(s, s.render, {.enabled = false});
        drawing.step(ms(0));
    }
    EXPECT_EQ(drawing.maps(), 1u);
    drawing.step();
    EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(s, s.render)));
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

TYPED_TEST_P(progressive, a_cancelled_step_ends_after_its_pass)
{
    const auto s = this->small_scene();
    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render);
    int steps = 0;
    while (!drawing.finished()) { // asked before it begins: one pass
        drawing.cancel();
        drawing.step();
        ++steps;
    }
    EXPECT_GE(steps, 8); // map begun, photons, map, view, rays, search, …
    EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(s, s.render)));

    // From another thread, into a step without end: far less is done than a picture takes.
    auto long_one = s;
    long_one.render.view.spp = 65536;
    drawing.start(long_one, long_one.render);
    std::thread impatient([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
        drawing.cancel();
    });
    EXPECT_FALSE(drawing.step());
    impatient.join();
    drawing.start(s, s.render); // a new picture is not touched by it
    EXPECT_TRUE(drawing.step());
    EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(s, s.render)));
}

TYPED_TEST_P(progressive, a_picture_goes_on_from_its_state)
{
    using ms = typename TestFixture::ms;
    auto s = this->small_scene();
    s.render.view.spp = 4;
    s.render.output.aov = true;
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
        }
    }
    EXPECT_GE(lives, 4);

    typename TestFixture::loop other(this->b());
    auto larger = s.render, without_layers = s.render;
    larger.output.width += 1;
    without_layers.output.aov = false;
    for (const auto& settings : {larger, without_layers}) {
        other.start(s, settings);
        EXPECT_THROW(other.resume(state), std::invalid_argument);
        EXPECT_THROW(other.resume({{}, {0, 1, {}}}), std::invalid_argument);
        EXPECT_FALSE(other.finished());
    }
    other.start(s, s.render);
    const auto n = expected.pixels.size();
    const std::vector<glm::vec4> some(n);
    other.resume({{}, {0, 17, {some, some, some}}}); // more rays than there are
    EXPECT_THROW(other.step(), std::invalid_argument);
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

TYPED_TEST_P(progressive, what_cannot_be_drawn_leaves_the_picture_alone)
{
    const auto s = this->small_scene();
    typename TestFixture::loop drawing(this->b());
    EXPECT_THROW(drawing.step(), std::logic_error);
    EXPECT_THROW(drawing.picture(), std::logic_error);
    EXPECT_FALSE(drawing.finished());
    drawing.start(s, s.render);
    drawing.step();
    const auto before = drawing.picture();
    auto broken = s;
    broken.spheres[0].radius = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(drawing.start(broken, s.render), std::invalid_argument);
    auto none = s.render;
    none.estimate.k = 0;
    EXPECT_THROW(drawing.start(s, none), std::invalid_argument);
    EXPECT_TRUE(drawing.finished());
    EXPECT_TRUE(same_bytes(drawing.picture(), before));

    // What fails in a step does not stay.
    drawing.start(s, s.render);
    const std::vector<glm::vec4> some(before.pixels.size());
    drawing.resume({{}, {0, 1000, {some, some, {}}}}); // more rays than there are
    EXPECT_THROW(drawing.step(), std::invalid_argument);
    drawing.start(s, s.render);
    drawing.step();
    EXPECT_TRUE(same_bytes(drawing.picture(), before));
}

REGISTER_TYPED_TEST_SUITE_P(progressive, ends_with_the_bytes_of_render, previews_are_as_bright_as_the_picture,
    a_map_serves_until_the_light_changes, a_camera_that_moves_while_photons_are_traced_does_not_begin_them_anew,
    previews_that_are_no_longer_wanted_are_not_drawn, a_cancelled_step_ends_after_its_pass,
    a_picture_goes_on_from_its_state, passes_add_up_in_any_order, what_cannot_be_drawn_leaves_the_picture_alone);

} // namespace photongrid::testing
