// Hard cases of ray tracing (docs/reference/hard_cases.md), on any backend. References are long double arithmetic
// written here, or analytic answers; then the serial backend, bit for bit. Each largest error is printed as "hard case
// ...". Included by each on_<backend>.cpp.
#pragma once
#include "b_axis_tests.hpp"
#include "b_intersection_tests.hpp"
#include "b_leaving_tests.hpp"
#include "b_shaft_tests.hpp"
#include "b_size_tests.hpp"
#include "c_refraction_tests.hpp"
#include "d_light_tests.hpp"
#include "e_random_tests.hpp"
#include "f_distance_tests.hpp"

namespace photongrid::testing {

REGISTER_TYPED_TEST_SUITE_P(hard_cases, b9_what_is_outside_a_shaft_blocks_nothing_in_it,
    b1_far_spheres_are_hit_within_rounding_of_the_distance, b2_a_large_sphere_is_hit_from_close_above,
    b3_hits_lie_on_their_quadric, b3_a_missing_root_is_never_a_hit, b4_no_ray_escapes_a_closed_mesh,
    b4_no_ray_passes_between_two_polygons, b5_rays_that_leave_a_surface_do_not_hit_it,
    long_b5_rays_that_leave_a_surface_do_not_hit_it, b5_rays_inside_a_sphere_reach_its_other_side,
    b6_nothing_blocks_the_way_to_a_lamp_close_to_a_wall, b7_degenerate_rays_hit_nothing, b8_bases_are_orthonormal,
    b16_a_small_ball_on_a_large_ground_is_drawn, b16_lamps_of_any_size_light_what_is_small,
    b16_rays_that_leave_small_shapes_do_not_hit_them, c1_refraction_is_finite_about_the_critical_angle,
    c2_energy_is_kept_down_to_grazing, c3_bodies_of_one_glass_must_not_overlap,
    c4_endless_total_reflection_is_cut_off_and_counted, c5_a_camera_in_glass_sees_through_it,
    d2_irradiance_close_to_a_lamp_is_bounded, d3_samples_at_the_ends_of_the_unit_interval_are_finite,
    d4_a_point_light_on_a_surface_is_finite, d5_dark_lights_are_refused, e1_random_numbers_stay_below_one,
    e3_hashes_have_known_answers, e3_streams_are_uniform_in_pairs,
    e4_sequences_have_a_point_in_each_elementary_interval, e4_sequences_are_independent_of_each_other,
    e6_seeds_are_independent, f6_a_scene_far_away_renders_the_same, f6_a_mesh_far_away_looks_the_same);

} // namespace photongrid::testing
