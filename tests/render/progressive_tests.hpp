// Guarantees of the interactive loop, on any backend: it ends with the bytes of render(), shows pictures of the same
// brightness before, traces photons only when it must, and stops when it is told to. Included by each on_<backend>.cpp.
#pragma once

#include "automatic_settings_tests.hpp"
#include "kept_map_tests.hpp"
#include "preview_tests.hpp"
#include "resumed_picture_tests.hpp"
#include "stop_rule_tests.hpp"
#include "world_tests.hpp"

#include <chrono>
#include <thread>

namespace photongrid::testing {

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
    ASSERT_GE(steps, 8); // map begun, photons, map, view, rays, search, …
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
    drawing.resume({{}, {0, 0, 1000, {}, {some, some, {}}}}); // more rays than there are
    EXPECT_THROW(drawing.step(), std::invalid_argument);
    drawing.start(s, s.render);
    drawing.step();
    EXPECT_TRUE(same_bytes(drawing.picture(), before));
}

REGISTER_TYPED_TEST_SUITE_P(progressive, ends_with_the_bytes_of_render, previews_are_as_bright_as_the_picture,
    running_estimates_approach_the_picture, a_map_serves_until_the_light_changes,
    a_camera_that_moves_while_photons_are_traced_does_not_begin_them_anew, an_edited_scene_shares_what_is_the_same,
    an_edit_draws_the_picture_of_the_edited_scene, all_passes_share_one_world, a_pass_is_a_function_of_its_number,
    a_preparation_can_be_interrupted, one_preview_is_drawn_where_no_more_are_wanted,
    previews_that_are_no_longer_wanted_are_not_drawn, a_cancelled_step_ends_after_its_pass,
    a_picture_goes_on_from_its_state, passes_add_up_in_any_order, bands_of_rows_make_the_same_picture,
    bands_of_rows_are_shown_from_the_top, bands_of_rows_go_on_from_their_states, a_state_of_more_passes_is_refused,
    a_picture_that_its_error_ends_has_the_bytes_of_as_many_passes,
    a_picture_that_time_ends_has_the_bytes_of_as_many_passes, automatic_settings_become_numbers,
    an_automatic_number_of_passes_is_drawn, an_automatic_radius_needs_no_pilot, a_pilot_traces_the_paths_of_the_picture,
    maps_and_views_need_numbers, what_cannot_be_drawn_leaves_the_picture_alone);

} // namespace photongrid::testing
