// See on_serial.cpp.
#include "double_kernels.hpp"
#include "edge_tests.hpp"
#include "on_serial.hpp"
#include "progressive_tests.hpp"
#include "ray_tests.hpp"
#include "render_tests.hpp"
#include "scene_picture_tests.hpp"

namespace photongrid::testing {

INSTANTIATE_TYPED_TEST_SUITE_P(serial, pictures, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, progressive, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, hard_cases, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, edges, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, scene_files, ::testing::Types<serial_tag>, tag_names);

} // namespace photongrid::testing
