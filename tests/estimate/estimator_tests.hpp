// Guarantees of the estimates beyond the paper's: exact k, kernels, bias, leak policies, standard errors. References:
// brute force in double over float distances, FLANN, statistics of uniform fields. Included by each on_<backend>.cpp.
#pragma once
#include "exact_search_tests.hpp"
#include "policy_tests.hpp"

namespace photongrid::testing {

REGISTER_TYPED_TEST_SUITE_P(estimators, every_setting_equals_brute_force, radii_at_points_equal_brute_force,
    half_spaces_equal_brute_force, every_combination_equals_brute_force,
    exact_k_finds_flanns_photons_on_every_distribution, ties_at_the_kth_distance_go_by_id, ties_in_many_cells_go_by_id,
    ties_of_repeated_photons_go_by_id, squared_distances_too_small_for_a_float_count_as_zero,
    photons_within_the_least_radius_are_all_summed, estimates_in_small_clusters_ignore_far_photons,
    discs_are_no_smaller_than_rounding_moves_photons, find_the_photons_of_brute_force_for_any_numbers,
    find_the_photons_of_brute_force_in_any_clumps, distances_next_to_each_other_are_told_apart,
    a_photon_on_a_face_is_found_from_any_distance, a_radius_holds_the_photons_on_its_rim,
    no_light_comes_through_a_thin_wall, no_light_comes_from_a_parallel_surface,
    no_photon_of_a_round_or_bent_surface_is_lost, searches_throw_for_wrong_settings,
    searches_can_be_watched_and_resumed, biases_do_not_change_what_they_are_of, equal_the_serial_backends_bit_for_bit);

} // namespace photongrid::testing
