// All backend tests on the serial backend.
#include "algorithm_tests.hpp"
#include "edge_tests.hpp"
#include "estimator_tests.hpp"
#include "double_kernels.hpp"
#include "number_tests.hpp"
#include "ray_tests.hpp"
#include "render_tests.hpp"
#include "scene_picture_tests.hpp"

namespace photongrid::testing {

struct serial_tag {
    using type = serial_backend;
    static constexpr const char* name = "serial";
    static std::unique_ptr<type> make() { return std::make_unique<type>(); }
};

INSTANTIATE_TYPED_TEST_SUITE_P(serial, algorithms, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, estimators, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, pictures, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, hard_cases, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, hard_cases_of_numbers, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, edges, ::testing::Types<serial_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(serial, scene_files, ::testing::Types<serial_tag>, tag_names);

} // namespace photongrid::testing
