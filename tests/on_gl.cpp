// All backend tests on OpenGL, in an EGL and in an OSMesa context.
#include "algorithm_tests.hpp"
#include "render_tests.hpp"
#include "scene_picture_tests.hpp"

#include <photongrid/backends/gl/gl.hpp>

namespace photongrid::testing {

struct egl_tag {
    using type = gl_backend;
    static constexpr const char* name = "egl";
    static std::unique_ptr<type> make() { return std::make_unique<type>(gl_options{.context = gl_context_kind::egl}); }
};
struct osmesa_tag {
    using type = gl_backend;
    static constexpr const char* name = "osmesa";
    static constexpr bool software_only = true;
    static std::unique_ptr<type> make() { return std::make_unique<type>(gl_options{.context = gl_context_kind::osmesa}); }
};
using contexts = ::testing::Types<egl_tag, osmesa_tag>;

INSTANTIATE_TYPED_TEST_SUITE_P(gl, algorithms, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, pictures, contexts, tag_names);
INSTANTIATE_TYPED_TEST_SUITE_P(gl, scene_files, contexts, tag_names);

} // namespace photongrid::testing
