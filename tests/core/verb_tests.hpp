// What each verb of a backend does, as backend.hpp promises it. References are loops in these tests. What
// algorithm_tests.hpp shows of buffers is not repeated here. Included by each on_<backend>.cpp.
#pragma once
#include "count_and_route_tests.hpp"
#include "run_tests.hpp"
#include "verb_buffer_tests.hpp"

namespace photongrid::testing {

REGISTER_TYPED_TEST_SUITE_P(verbs, buffers_keep_delicate_floats, buffers_move_and_may_outlive_their_backend,
    a_buffer_may_be_destroyed_before_passes_that_use_it_end, memory_is_given_back,
    a_buffer_beyond_the_limit_is_refused_and_nothing_else, too_small_buffers_are_refused_by_name,
    a_pass_computes_its_elements_and_no_other, a_pass_has_eight_inputs_and_eight_outputs_of_mixed_types,
    states_change_in_place_and_outputs_beside_them, switches_are_on_and_off_one_by_one, parameters_of_every_kind_arrive,
    a_pass_reads_one_part_of_a_buffer_and_writes_another, each_pass_sees_what_all_before_it_wrote,
    elements_take_as_many_passes_as_they_need, a_count_is_of_its_elements_and_exact,
    a_route_keeps_the_first_draws_and_adds_up_all, passes_are_counted_by_kernel, finish_may_be_called_at_any_time,
    capabilities_can_be_worked_with);

} // namespace photongrid::testing
