// Guarantees of the four algorithms, on any backend. References: std::, brute force, FLANN; then the serial backend,
// bit for bit. Included by each on_<backend>.cpp, which instantiates the suite for its tags.
#pragma once
#include "block_map_tests.hpp"
#include "buffer_tests.hpp"
#include "hashed_route_tests.hpp"
#include "route_tests.hpp"
#include "search_tests.hpp"
#include "sort_tests.hpp"
#include "whole_map_tests.hpp"

namespace photongrid::testing {

REGISTER_TYPED_TEST_SUITE_P(algorithms, a_fitting_grid_suits_any_photons, buffers_keep_every_bit,
    a_pass_outside_a_buffer_is_refused, memory_is_accounted_for,
    the_self_test_of_arithmetic_agrees_with_the_capabilities,
    no_photon_lies_beyond_the_last_of_more_cells_than_floats_count, sort_equals_std_sort_for_any_size_and_keys,
    sort_handles_the_sizes_where_networks_break, the_generic_sort_is_right_where_an_override_replaces_it,
    sort_reports_the_papers_numbers_of_passes, long_a_million_pairs_sort_and_index, index_equals_the_histogram,
    route_keeps_the_first_in_draw_order_and_all_power, route_conserves_unequal_powers_and_absent_channels,
    route_takes_a_hundred_thousand_photons_to_one_cell, route_conserves_power_in_crowded_cells,
    route_is_fair_to_later_photons, photons_of_a_routed_map_stand_for_those_without_a_slot,
    a_map_of_one_part_of_the_light_holds_that_part, route_throws_for_wrong_arguments,
    estimate_uses_exactly_the_photons_within_its_radius, estimate_adds_up_the_power_of_its_photons,
    estimate_defines_what_has_no_neighbours, coincident_photons_give_a_finite_estimate,
    poisoned_photons_are_counted_and_harmless, a_search_can_be_watched_and_resumed,
    all_photons_in_one_cell_are_all_visited, blocks_hold_every_photon_once_in_boxes_that_fit,
    block_maps_equal_the_serial_backends, searches_in_blocks_are_exact_at_every_scale,
    fitted_maps_are_of_the_kind_that_suits_the_photons, hashed_buckets_keep_the_first_in_draw_order,
    hashed_routes_take_hard_cases, hashed_routes_conserve_power_in_crowded_cells,
    ranks_of_virtual_cells_are_the_occupied_cells_of_a_stored_grid, hashed_routes_equal_the_serial_backends,
    hashed_cells_have_their_power_in_the_mean_and_the_predicted_variance, errors_of_hashed_survivors_cover_the_thinning,
    searches_among_hashed_survivors_are_exact, hashed_routes_throw_for_wrong_arguments,
    everything_equals_the_serial_backend_bit_for_bit);

} // namespace photongrid::testing
