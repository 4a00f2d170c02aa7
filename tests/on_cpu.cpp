// All backend tests on the cpu backend with its overrides, on three threads whatever the machine has, and those of its
// own: one program, since compiling the overrides for every instruction set takes long.
#include <photongrid/backends/cpu/overrides/all.hpp>

#include "algorithm_tests.hpp"
#include "cpu_backend_tests.hpp"
#include "edge_tests.hpp"
#include "estimator_tests.hpp"
#include "map_file_tests.hpp"
#include "neighbour_tests.hpp"
#include "number_tests.hpp"
#include "progressive_tests.hpp"
#include "ray_tests.hpp"
#include "render_tests.hpp"
#include "scene_picture_tests.hpp"
#include "verb_tests.hpp"

namespace photongrid::testing {

struct cpu_tag {
    using type = cpu_backend;
    static constexpr const char* name = "cpu";
    /// It sorts by digits, in fewer passes than the network's, and adds up photons in another order than the kernels.
    static constexpr bool sorts_by_network = false, adds_as_serial = false;
    static std::unique_ptr<type> make() { return std::make_unique<type>(3u); }
};

INSTANTIATE_TYPED_TEST_SUITE_P(cpu, verbs, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, algorithms, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, estimators, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, pictures, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, progressive, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, hard_cases, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, neighbours, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, hard_cases_of_numbers, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, edges, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, map_files, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, scene_files, ::testing::Types<cpu_tag>, tag_names);

} // namespace photongrid::testing
