// All backend tests on Vulkan with its overrides, with the validation layer watching.
#include "on_vulkan.hpp"

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

#include <photongrid/trace/bounce_photon.kernel.hpp>

namespace photongrid::testing {

INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, verbs, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, algorithms, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, estimators, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, pictures, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, mesh_scenes, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, light_kinds, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, textures, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, mixtures, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, media, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, hard_cases_of_pictures, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, progressive, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, hard_cases, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, mesh_rays, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, instances, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, boxes, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, neighbours, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, hard_cases_of_numbers, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, edges, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, probed_edges, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, map_files, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, scene_files, ::testing::Types<vulkan_tag>, tag_names);

TEST(bitonic_sort_on_vulkan, takes_one_to_four_steps_a_pass)
{
    std::string reason;
    auto* b = shared_backend<vulkan_tag>(reason);
    if (b == nullptr)
        GTEST_SKIP() << reason;
    for (const uint steps : {1u, 2u, 3u, 4u})
        for (const std::size_t n : {2u, 4u, 8u, 15u, 16u, 1000u, 4096u}) {
            random_source u(n);
            std::vector<uvec2> pairs;
            for (std::size_t i = 0; i < n; ++i)
                pairs.emplace_back(u.below(50), u.below(50));
            auto buffer = b->upload(std::span<const uvec2>(pairs));
            const auto report = bitonic_sort(*b, buffer, steps);
            EXPECT_LE(report.passes, report.steps);
            std::sort(pairs.begin(), pairs.end(), [](uvec2 x, uvec2 y) { return x.x != y.x ? x.x < y.x : x.y < y.y; });
            EXPECT_EQ(b->download(buffer), pairs) << n << " pairs, " << steps << " steps";
        }
    auto buffer = b->make<uvec2>(8);
    EXPECT_THROW((void)bitonic_sort(*b, buffer, 0), std::invalid_argument);
    EXPECT_THROW((void)bitonic_sort(*b, buffer, 5), std::invalid_argument);
}

/// The kernels of a scene contain code only for its features.
TEST(specialisation, a_scene_without_glass_and_lamps_has_smaller_kernels)
{
    std::string reason;
    auto* b = shared_backend<vulkan_tag>(reason);
    if (b == nullptr)
        GTEST_SKIP() << reason;
    const auto instructions = [&](const scene& s) {
        vulkan_backend fresh(vulkan_options{});
        const auto device = upload_scene(fresh, s);
        detail::photon_frames<vulkan_backend> f(fresh, 64);
        const detail::mesh_hits<vulkan_backend> none(fresh, device, 0);
        fresh.run<kernels::bounce_photon>({32, 32u, device.layout.features},
            {.paths = 32, .first_path = 0, .last_frame = 1, .seed = 1, .ends = kernels::NOTHING_ENDS},
            reads(device.records, f.positions, f.powers, f.directions, f.next_origins, f.next_directions, none.places,
                none.normals, none.shadings, none.colors),
            writes(f.positions, f.powers, f.directions, f.next_origins, f.next_directions));
        fresh.finish();
        return fresh.costs().at("bounce_photon").instructions;
    };
    auto plain = all_shapes(); // mirrors, quadrics and polygons under a bulb
    plain.spheres.clear();
    plain.boxes.clear();
    plain.disks.clear();
    plain.rectangle_lights.clear();
    const auto least = instructions(plain);
    EXPECT_GT(least, 100u);
    auto other = plain;
    other.materials.push_back({"clear", material_kind::glass, dvec3(1), 1.5});
    EXPECT_EQ(instructions(other), least) << "no shape is of this material";
    EXPECT_EQ(detail::splits_of(lay_out(other)), 0u);
    other = plain;
    other.spheres = all_shapes().spheres;
    other.spheres[0].material = 0;
    const auto with_spheres = instructions(other);
    EXPECT_GT(with_spheres, least);
    other.spheres[0].material = 2; // glass
    EXPECT_GT(instructions(other), with_spheres);
    other = plain;
    other.rectangle_lights = all_shapes().rectangle_lights;
    EXPECT_GT(instructions(other), least);
}

} // namespace photongrid::testing
