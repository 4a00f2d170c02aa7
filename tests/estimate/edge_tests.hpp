// Edge correction (docs/reference/hard_cases.md, A9), on any backend: shares and moments of discs against integration
// over scan lines in double, uniform fields and a picture whose light is known up to the rim. Included by each
// on_<backend>.cpp.
#pragma once
#include "corrected_light_tests.hpp"
#include "moment_tests.hpp"
#include "probe_tests.hpp"
#include "share_tests.hpp"

namespace photongrid::testing {

REGISTER_TYPED_TEST_SUITE_P(edges, angles_and_logarithms_are_those_of_the_library, shares_equal_integration_over_lines,
    shares_have_the_known_values_of_a_square, bent_walls_hold_together_up_to_two_degrees_and_a_half,
    lamps_and_mirrors_hide_what_lies_behind_them, thousands_of_polygons_take_several_passes,
    shares_are_bounded_before_they_divide, moments_equal_integration_over_lines, a_slope_beside_an_edge_is_reported,
    uniform_squares_read_one_up_to_their_corners, even_light_has_no_bias_beside_an_edge,
    a_floor_lit_by_a_mirror_is_right_up_to_its_rim, a_floor_is_right_up_to_a_plate_on_it,
    pictures_equal_the_serial_backends, correction_needs_the_normals_policy);

} // namespace photongrid::testing
