// All backend tests on OpenGL with its overrides, in an EGL or in an OSMesa context, with the driver's debug output on.
#include "gl_algorithms.hpp"

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

#include <all_kernels.hpp>
#include <photongrid/backends/gl/gl.hpp>

namespace photongrid::testing {

/// The context under test: PHOTONGRID_GL_CONTEXT=osmesa, else EGL. One at a time halves what the compiler has to do.
struct gl_tag {
    using type = gl_backend;
    static bool on_osmesa()
    {
        const char* context = std::getenv("PHOTONGRID_GL_CONTEXT");
        return context != nullptr && std::string_view(context) == "osmesa";
    }
    static constexpr bool sorts_by_network = false; // up to three steps of it a pass
    static inline const char* const name = on_osmesa() ? "osmesa" : "egl";
    static bool never_hardware() { return on_osmesa(); }
    static std::unique_ptr<type> make()
    {
        auto b = std::make_unique<gl_backend>(
            gl_options{.context = on_osmesa() ? gl_context_kind::osmesa : gl_context_kind::egl, .debug = true});
        return b;
    }
};
using contexts = ::testing::Types<gl_tag>;

INSTANTIATE_TYPED_TEST_SUITE_P(gl, verbs, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, algorithms, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, estimators, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, pictures, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, hard_cases_of_pictures, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, progressive, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, hard_cases, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, boxes, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, neighbours, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, hard_cases_of_numbers, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, edges, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, map_files, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, scene_files, contexts, tag_names);

/// After all other tests of this program: the driver had nothing of high severity to say. That it would is tested in
/// gl_backend.cpp.
class no_debug_messages : public ::testing::Environment {
    void TearDown() override
    {
        std::string reason;
        if (auto* b = shared_backend<gl_tag>(reason); b != nullptr) {
            EXPECT_EQ(b->take_debug_messages(), "") << gl_tag::name;
        }
    }
};
const auto* const watched = ::testing::AddGlobalTestEnvironment(new no_debug_messages);

/// Between the first pass and the last nothing comes back to the CPU but the results of occlusion queries.
template <class Tag>
class readbacks : public on_backend<Tag> {
};
TYPED_TEST_SUITE(readbacks, contexts, tag_names);

TYPED_TEST(readbacks, a_whole_picture_reads_no_pixel_back)
{
    auto& b = this->b();
    const auto s = small_cornell();
    for (const auto builder : {map_builder::sort, map_builder::route}) {
        auto settings = s.render;
        settings.map.builder = builder;
        const auto before = b.readbacks();
        std::uint64_t at_the_last_pass = 0;
        render_observer observer;
        observer.progress = [&](std::string_view stage, double) {
            if (stage == "radiance_estimate")
                at_the_last_pass = b.readbacks();
        };
        (void)render(b, s, settings, observer);
        EXPECT_EQ(at_the_last_pass, before);
        EXPECT_GT(b.readbacks(), before); // the picture itself: the counter counts
    }
}

template <class Tag>
class kernels_on_gl : public on_backend<Tag> {
};
TYPED_TEST_SUITE(kernels_on_gl, contexts, tag_names);

template <class... K>
struct each_kernel {
    static void compile(gl_backend& b)
    {
        (b.compile<K>(0u), ...);
        (b.compile<K>(~0u), ...);
    }
};

TYPED_TEST(kernels_on_gl, compiles_every_kernel_for_every_verb) { all_kernels<each_kernel>::compile(this->b()); }

} // namespace photongrid::testing
