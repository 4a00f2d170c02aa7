// The OpenGL backend under test, in an EGL or in an OSMesa context, with the driver's debug output on.
#pragma once

#include "../core/under_test.hpp"
#include "gl_algorithms.hpp"

#include <string_view>

namespace photongrid::testing {

/// The context under test: PHOTONGRID_GL_CONTEXT=osmesa, else EGL. One at a time halves what the compiler has to do.
struct gl_tag {
    using type = gl_backend;
    static bool on_osmesa()
    {
        const char* context = std::getenv("PHOTONGRID_GL_CONTEXT");
        return context != nullptr && std::string_view(context) == "osmesa";
    }
    static constexpr bool sorts_by_network = false;               // up to three steps of it a pass
    static constexpr unsigned peak_bytes_per_photon = 48 + 3 * 8; // pairs, and twice as texels of two
    static inline const char* const name = on_osmesa() ? "osmesa" : "egl";
    static bool never_hardware() { return on_osmesa(); }
    static std::unique_ptr<type> make()
    {
        auto b = std::make_unique<gl_backend>(
            gl_options{.context = on_osmesa() ? gl_context_kind::osmesa : gl_context_kind::egl, .debug = true});
        return b;
    }
};
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
inline const auto* const watched_driver = ::testing::AddGlobalTestEnvironment(new no_debug_messages);

} // namespace photongrid::testing
