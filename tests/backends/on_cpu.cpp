// All backend tests on the cpu backend with its overrides, which are photongrid::cpu_compiled's, and those of its own.
#include "on_cpu.hpp"

#include "../core/number_tests.hpp"
#include "../core/verb_tests.hpp"
#include "../estimate/edge_tests.hpp"
#include "../estimate/estimator_tests.hpp"
#include "../estimate/neighbour_tests.hpp"
#include "../map/algorithm_tests.hpp"
#include "../map/map_file_tests.hpp"
#include "../render/number_picture_tests.hpp"
#include "../render/progressive_tests.hpp"
#include "../render/render_tests.hpp"
#include "../render/scene_picture_tests.hpp"
#include "../trace/box_tests.hpp"
#include "../trace/instance_tests.hpp"
#include "../trace/light_kind_tests.hpp"
#include "../trace/media_tests.hpp"
#include "../trace/mesh_ray_tests.hpp"
#include "../trace/mesh_scene_tests.hpp"
#include "../trace/mixture_tests.hpp"
#include "../trace/ray_tests.hpp"
#include "../trace/texture_tests.hpp"
#include "cpu_backend_tests.hpp"

namespace photongrid::testing {

INSTANTIATE_TYPED_TEST_SUITE_P(cpu, verbs, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, algorithms, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, estimators, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, pictures, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, mesh_scenes, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, light_kinds, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, textures, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, mixtures, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, media, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, hard_cases_of_pictures, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, progressive, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, hard_cases, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, mesh_rays, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, instances, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, boxes, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, neighbours, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, hard_cases_of_numbers, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, edges, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, probed_edges, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, map_files, ::testing::Types<cpu_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(cpu, scene_files, ::testing::Types<cpu_tag>, tag_names);

} // namespace photongrid::testing
