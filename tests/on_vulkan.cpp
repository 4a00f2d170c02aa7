// All backend tests on Vulkan, with the validation layer watching.
#include "algorithm_tests.hpp"
#include "edge_tests.hpp"
#include "estimator_tests.hpp"
#include "number_tests.hpp"
#include "ray_tests.hpp"
#include "render_tests.hpp"
#include "scene_picture_tests.hpp"

#include <photongrid/backends/vulkan/vulkan.hpp>

namespace photongrid::testing {

struct vulkan_tag {
    using type = vulkan_backend;
    static constexpr const char* name = "vulkan";
    /// PHOTONGRID_GPU_AV=1 has the layer watch inside the kernels too: tests/run.sh --full.
    static std::unique_ptr<type> make()
    {
        auto b = std::make_unique<type>(vulkan_options{.validation = true, .gpu_assisted = std::getenv("PHOTONGRID_GPU_AV") != nullptr});
        b->use_texts(test_kernel_texts);
        return b;
    }
};

INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, algorithms, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, estimators, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, pictures, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, hard_cases, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, hard_cases_of_numbers, ::testing::Types<vulkan_tag>, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(vulkan, edges, ::testing::Types<vulkan_tag>, tag_names);
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

/// The kernels of a scene hold code only for what the scene has.
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
        fresh.run<kernels::bounce_photon>({32, 32u, features}, {.scene_layout = device.about.layout, .paths = 32, .first_path = 0, .last_frame = 1, .seed = 1},
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

} // namespace photongrid::testing
