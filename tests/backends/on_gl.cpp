// All backend tests on OpenGL with its overrides, in an EGL or in an OSMesa context, with the driver's debug output on.
#include "on_gl.hpp"

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

namespace photongrid::testing {

using contexts = ::testing::Types<gl_tag>;

INSTANTIATE_TYPED_TEST_SUITE_P(gl, verbs, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, algorithms, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, estimators, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, pictures, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, mesh_scenes, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, light_kinds, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, textures, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, mixtures, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, media, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, hard_cases_of_pictures, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, progressive, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, hard_cases, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, mesh_rays, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, instances, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, boxes, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, neighbours, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, hard_cases_of_numbers, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, edges, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, probed_edges, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, map_files, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, scene_files, contexts, tag_names);

/// Between the first pass and the last nothing comes back to the CPU but the results of occlusion queries.
template <class Tag>
class readbacks : public on_backend<Tag> {
};
TYPED_TEST_SUITE(readbacks, contexts, tag_names);

TYPED_TEST(readbacks, a_whole_picture_reads_no_pixel_back)
{
    auto& b = this->b();
    const auto s = small_cornell();
    for (const auto& [builder, emission] : {std::pair{map_builder::sort, photon_emission::power},
             {map_builder::route, photon_emission::power}, {map_builder::sort, photon_emission::guided}}) {
        auto settings = s.render;
        settings.map.builder = builder;
        settings.map.emission = emission;
        const auto before = b.readbacks();
        std::uint64_t at_the_last_pass = 0;
        render_observer observer;
        observer.progress = [&](std::string_view stage, double) {
            if (stage == "radiance_estimate")
                at_the_last_pass = b.readbacks();
        };
        (void)render(b, s, settings, observer);
        // Which pilot paths are useful is read back, once a scene.
        EXPECT_EQ(at_the_last_pass, before + (emission == photon_emission::guided ? 1 : 0));
        EXPECT_GT(b.readbacks(), at_the_last_pass); // the picture itself: the counter counts
    }
}

} // namespace photongrid::testing
