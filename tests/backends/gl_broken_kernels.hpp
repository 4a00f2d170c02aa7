// Kernels with mistakes for tests of the OpenGL backend. C++ does not see the mistakes: each kernel has a text of its
// own for OpenGL.
#pragma once

#include <photongrid/core/kernel.hpp>
#include <photongrid/map/grid.kernel.hpp>

#include <cassert>
#include <span>
#include <string_view>

namespace photongrid {
namespace {

    namespace test_kernels {
        using namespace glm;
#include <photongrid/core/begin.hpp>
#define TEST_KERNEL(FILE)                                                                                              \
    Params args{};                                                                                                     \
    static constexpr std::string_view path = FILE;

        struct broken {
            struct Params {
                uint unused;
            };
            TEST_KERNEL("broken.glsl")
            OUTPUT(0, uint, value)
            void kernel(uint i) { value = i; }
        };
        struct misspelt : broken {
            static constexpr std::string_view path = "misspelt.glsl";
        };
        struct wrongly_laid_out {
            struct Params {
                vec2 a;
                float b;
                vec4 c;
                uint d;
            };
            TEST_KERNEL("wrongly_laid_out.glsl")
            OUTPUT(0, uint, value)
            void kernel(uint i) { value = i; }
        };
#undef TEST_KERNEL
#include <photongrid/core/end.hpp>
    } // namespace test_kernels

    constexpr text_file test_texts[] = {
        kernel_texts::grid,
        // An error that only the compiler proper finds (line 6) and one of syntax (line 7).
        {"tests/broken.glsl", R"glsl(struct Params {
    uint unused;
};
PARAMS(Params)
OUTPUT(0, uint, value)
void kernel(uint i) { value = i.w; }
)glsl"},
        {"tests/misspelt.glsl", R"glsl(#include "grid.glsl"
struct Params {
    uint unused;
};
PARAMS(Params)
OUTPUT(0, uint, value)
void kernel(uint i) { value = i }
)glsl"},
        {"tests/wrongly_laid_out.glsl", R"glsl(struct Params {
    vec2 a;
    float b;
    vec4 c;
    uint d;
};
PARAMS(Params)
OUTPUT(0, uint, value)
void kernel(uint i) { value = i; }
)glsl"},
    };

} // namespace
} // namespace photongrid
