// Guarantees of the renderer, on any backend: scenes with known answers, the balance of photons, and the serial
// backend's picture. Included by each on_<backend>.cpp.
#pragma once

#include "caustic_map_tests.hpp"
#include "equal_picture_tests.hpp"
#include "exact_tests.hpp"
#include "final_gather_tests.hpp"
#include "interpolation_tests.hpp"
#include "known_energy_tests.hpp"
#include "known_picture_tests.hpp"
#include "photon_account_tests.hpp"
#include "rough_photon_tests.hpp"

namespace photongrid::testing {

TYPED_TEST_P(pictures, a_moved_camera_runs_no_photon_pass)
{
    auto& b = this->b();
    const auto s = small_cornell();
    const auto built = build_map(b, s, s.render);
    const auto passes = [&](const char* kernel) {
        const auto at = b.costs().find(kernel);
        return at == b.costs().end() ? std::uint64_t{0} : at->second.passes;
    };
    const auto bounces = passes("bounce_photon"), sorts = passes("bitonic_step"), rays = passes("eye_ray");
    auto view = s.camera;
    const auto first = draw(b, built, view, s.render).picture;
    view.position.x += 0.2;
    const auto second = draw(b, built, view, s.render).picture;
    EXPECT_EQ(passes("bounce_photon"), bounces);
    EXPECT_EQ(passes("bitonic_step"), sorts);
    EXPECT_GT(passes("eye_ray"), rays);
    EXPECT_GT(relative_mse(first, second), 1e-3);
}

TYPED_TEST_P(pictures, a_view_without_pixels_or_direction_is_refused)
{
    auto& b = this->b();
    auto s = small_cornell();
    s.render.map.photons = 100;
    const auto built = build_map(b, s, s.render);
    auto narrow = s.render, flat = s.render;
    narrow.output.width = 0;
    flat.output.height = 0;
    auto blind = s.camera;
    blind.look_at = blind.position;
    EXPECT_THROW((void)draw(b, built, s.camera, narrow), std::invalid_argument);
    EXPECT_THROW((void)draw(b, built, s.camera, flat), std::invalid_argument);
    EXPECT_THROW((void)draw(b, built, blind, s.render), std::invalid_argument);
    EXPECT_EQ(draw(b, built, s.camera, s.render).picture.pixels.size(), 64u * 64u);
}

TYPED_TEST_P(pictures, running_estimates_are_shown_and_a_render_can_be_cancelled)
{
    auto& b = this->b();
    const auto s = small_cornell();
    auto settings = s.render;
    settings.estimate.k = 4000; // some passes
    settings.estimate.max_radius = 1;
    settings.output.width = 24;
    settings.output.height = 18;
    std::vector<image> shown;
    render_observer watch;
    watch.intermediate = [&](const image& im) { shown.push_back(im); };
    const auto watched = render(b, s, settings, watch).picture;
    const auto unwatched = this->picture(s, settings);
    EXPECT_TRUE(same_bytes(watched, unwatched));
    ASSERT_GE(shown.size(), 1u);
    EXPECT_EQ(shown[0].pixels.size(), watched.pixels.size());

    render_observer impatient;
    int asked = 0;
    impatient.cancelled = [&] { return ++asked > 2; };
    EXPECT_THROW((void)render(b, s, settings, impatient), render_cancelled);
    EXPECT_NO_THROW(this->picture(s));
}

REGISTER_TYPED_TEST_SUITE_P(pictures, caustic_photons_of_their_own_have_the_power_that_optics_predicts,
    the_account_is_exact_with_a_map_of_caustic_photons, maps_end_with_fewer_photons_rather_than_trace_for_ever,
    the_parts_of_a_picture_with_a_map_of_caustic_photons_add_up,
    a_map_of_caustic_photons_brings_the_light_of_the_map_of_all, maps_of_caustic_photons_equal_serials,
    maps_of_caustic_photons_are_sorted_where_others_are_routed,
    maps_of_caustic_photons_do_not_depend_on_how_passes_are_run, a_view_of_a_map_without_its_caustics_is_refused,
    a_closed_diffuse_sphere_has_the_known_radiance, direct_light_of_a_rectangle_equals_the_form_factor,
    a_glass_ball_focuses_the_power_that_optics_predicts, every_photon_and_every_watt_is_accounted_for,
    paths_that_overflow_are_counted_as_invalid, power_balances_per_channel, a_photon_takes_the_memory_that_is_stated,
    long_statistics_of_a_picture_equal_serials, cut_off_paths_are_counted, equal_the_serial_backends,
    sorting_and_routing_agree, sorting_and_blocks_agree, an_automatic_map_of_a_room_is_in_a_fitted_grid,
    a_moved_camera_runs_no_photon_pass, a_view_without_pixels_or_direction_is_refused,
    the_same_seed_gives_the_same_bytes, running_estimates_are_shown_and_a_render_can_be_cancelled,
    a_ball_of_each_material_amid_lamps_has_the_known_radiance, a_floor_under_a_bulb_has_the_known_radiance,
    photons_have_the_power_that_their_surfaces_left_them, eye_rays_of_a_pixel_share_out_the_choices_in_glass,
    direct_light_alone_traces_no_photon, scenes_beyond_the_loop_limit_are_refused,
    a_lone_object_under_any_light_is_drawn, a_scene_without_indirect_light_is_drawn_by_every_map,
    photons_of_tracing_that_ends_early_have_their_whole_power, the_irradiance_at_the_nearest_photon_has_the_right_mean,
    irradiance_at_photons_equals_brute_force, a_final_gather_in_a_closed_sphere_has_the_known_radiance,
    a_final_gather_below_a_coat_has_the_known_radiance, a_final_gather_has_the_known_radiance_in_a_corner,
    the_parts_of_a_gathered_picture_add_up, a_final_gather_equals_serials, a_gathered_picture_does_not_depend_on_bands,
    passes_have_the_radii_of_the_first_map_made_smaller, a_map_of_fewer_photons_gives_radii_as_large,
    shrinking_radii_equal_serials, shrinking_radii_do_not_depend_on_how_passes_are_run, biases_equal_serials,
    blur_fades_with_shrinking_radii, the_rays_of_a_gather_are_progress, gather_rays_are_stratified_over_passes,
    paths_in_a_closed_sphere_have_the_known_radiance, paths_have_the_known_radiance_in_a_corner, paths_equal_serials,
    an_exact_picture_does_not_depend_on_how_it_is_run, an_exact_caustic_converges_at_the_rate_of_theory,
    estimates_are_searched_for_or_interpolated_between_near_ones, photons_that_crowd_between_estimates_are_not_missed,
    estimates_are_not_interpolated_over_edges, interpolated_pictures_are_close_and_equal_serials,
    rough_surfaces_behind_a_pane_have_the_known_light, parts_of_mixtures_show_their_share_of_light_behind_a_pane,
    light_of_lamps_with_a_size_behind_a_pane_is_not_counted_twice, scenes_without_matte_surfaces_are_drawn,
    photons_on_rough_surfaces_equal_serials, light_on_rough_surfaces_does_not_depend_on_how_passes_are_run,
    photons_are_on_rough_surfaces_only_where_rays_find_no_light, exact_indirect_light_converges_as_fast_as_noise,
    a_view_of_a_map_without_a_gather_is_refused);

} // namespace photongrid::testing
