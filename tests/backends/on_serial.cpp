// All backend tests on the serial backend; those of rays and pictures in on_serial_pictures.cpp, so that two cores
// compile them.
#include "on_serial.hpp"
#include "../core/number_tests.hpp"
#include "../core/verb_tests.hpp"
#include "../estimate/estimator_tests.hpp"
#include "../estimate/neighbour_tests.hpp"
#include "../map/algorithm_tests.hpp"
#include "../trace/instance_tests.hpp"
#include "../trace/mesh_ray_tests.hpp"
#include "serial_pictures.hpp"

namespace photongrid::testing {

INSTANTIATE_TYPED_TEST_SUITE_P(serial, verbs, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, algorithms, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, estimators, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, neighbours, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, mesh_rays, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, instances, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, hard_cases_of_numbers, ::testing::Types<serial_tag>, tag_names);

} // namespace photongrid::testing
