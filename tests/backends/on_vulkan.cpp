// All backend tests on Vulkan with its overrides, with the validation layer watching.
#include "vulkan_algorithms.hpp"
#include <photongrid/trace/bounce_photon.kernel.hpp>

#include "../backend/number_tests.hpp"
#include "../backend/verb_tests.hpp"
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
#include "../trace/ray_tests.hpp"
#include "vulkan_kernels.hpp"

#include <all_kernels.hpp>
#include <photongrid/backends/vulkan/vulkan.hpp>

namespace photongrid::testing {

struct vulkan_tag {
    using type = vulkan_backend;
    static constexpr const char* name = "vulkan";
    static constexpr bool sorts_by_network = false; // up to four steps of it a pass
    /// PHOTONGRID_GPU_AV=1 has the layer watch inside the kernels too: tests/run.sh --full.
    static std::unique_ptr<type> make()
    {
        auto b = std::make_unique<type>(
            vulkan_options{.validation = true, .gpu_assisted = std::getenv("PHOTONGRID_GPU_AV") != nullptr});
        return b;
    }
};

INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, verbs, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, algorithms, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, estimators, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, pictures, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, hard_cases_of_pictures, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, progressive, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, hard_cases, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, boxes, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, neighbours, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, hard_cases_of_numbers, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, edges, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, map_files, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, scene_files, ::testing::Types<vulkan_tag>, tag_names);

/// After all other tests of this program: the layer had nothing to say.
class no_validation_messages : public ::testing::Environment {
    void TearDown() override
    {
        std::string reason;
        if (auto* b = shared_backend<vulkan_tag>(reason); b != nullptr)
            for (const auto& m : b->validation_messages())
                ADD_FAILURE() << m;
    }
};
const auto* const watched = ::testing::AddGlobalTestEnvironment(new no_validation_messages);

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
    const auto instructions = [&](uint features) {
        vulkan_backend fresh(vulkan_options{});
        scene s = all_shapes();
        const auto device = upload_scene(fresh, s);
        detail::photon_frames<vulkan_backend> f(fresh, 64);
        fresh.run<kernels::bounce_photon>({32, 32u, features},
            {.paths = 32, .first_path = 0, .last_frame = 1, .seed = 1},
            reads(device.records, f.positions, f.powers, f.directions, f.next_origins, f.next_directions),
            writes(f.positions, f.powers, f.directions, f.next_origins, f.next_directions));
        fresh.finish();
        return fresh.costs().at("bounce_photon").instructions;
    };
    const uint ring = has_quadrics | has_polygons | has_mirrors | has_point_lights;
    EXPECT_GT(instructions(ring), 100u);
    EXPECT_LT(instructions(ring), instructions(ring | has_glass | has_area_lights));
    EXPECT_LT(instructions(ring), instructions(ring | has_spheres));
}

// Hard case G6.
TEST(kernels_on_vulkan, every_kernel_compiles_to_valid_spirv_without_contraction)
{
    std::string reason;
    auto* b = shared_backend<vulkan_tag>(reason);
    if (b == nullptr)
        GTEST_SKIP() << reason;
    expect_valid(*b, all_kernels<kernel_list>{});
}

TEST(kernels_on_vulkan, parameters_stand_where_cpp_has_them)
{
    std::string reason;
    auto* b = shared_backend<vulkan_tag>(reason);
    if (b == nullptr)
        GTEST_SKIP() << reason;
    expect_equal_layouts(*b, all_kernels<kernel_list>{});
    static_assert(sizeof(kernels::Grid) % 16 == 0);
}

} // namespace photongrid::testing
