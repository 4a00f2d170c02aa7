// Kernels of the tests of the OpenGL backend: the same text for C++ and for OpenGL.
#pragma once

#include "gl_algorithms.hpp"
#include "serial_algorithms.hpp"

#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/bitonic_sort.hpp>
#include <photongrid/map/build_map.hpp>
#include <photongrid/map/grid.kernel.hpp>
#include <photongrid/map/grid_index.hpp>
#include <photongrid/map/pair_value.kernel.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <numeric>
#include <optional>
#include <random>
#include <thread>

namespace photongrid {
namespace {

    // --- kernels of these tests: the same text for C++ and, below, for OpenGL
    // -----------------------------------------
    namespace test_kernels {
        using namespace glm;
#include <photongrid/backend/begin.hpp>
#define TEST_KERNEL(FILE)                                                                                              \
    Params args{};                                                                                                     \
    static constexpr std::string_view path = FILE;

        // Reads element i - args.stride of its own output: the frame before.
        struct next_frame {
            struct Params {
                uint stride;
            };
            TEST_KERNEL("next_frame.glsl")
            INPUT(0, uvec2, frames)
            OUTPUT(0, uvec2, frame)
            void kernel(uint i) { frame = frames(i - args.stride) + uvec2(1u, i); }
        };
        // Eight states and eight inputs; element i takes i % 37 + 1 passes.
        struct eight {
            struct Params {
                uint add;
            };
            TEST_KERNEL("eight.glsl")
            SWITCH(1, DOUBLED)
            INPUT(0, float, in0)
            INPUT(1, vec2, in1)
            INPUT(2, vec4, in2)
            INPUT(3, uint, in3)
            INPUT(4, uvec2, in4)
            INPUT(5, uvec4, in5)
            INPUT(6, uint, in6)
            INPUT(7, uint, in7)
            STATE(0, float, s0)
            STATE(1, vec2, s1)
            STATE(2, vec4, s2)
            STATE(3, uint, s3)
            STATE(4, uvec2, s4)
            STATE(5, uvec4, s5)
            STATE(6, uint, s6)
            STATE(7, uint, left)
            bool done() { return left == 0u; }
            void kernel(uint i)
            {
                s0 += in0(i);
                s1 += in1(i);
                s2 += in2(i);
                s3 += in3(i) + args.add;
                s4 += in4(i);
                s5 += in5(i);
                s6 += in6(i) + in7(i);
                left -= 1u;
                if (DOUBLED)
                    s6 += 1000u;
            }
        };
        struct is_odd {
            struct Params {
                uint unused;
            };
            TEST_KERNEL("is_odd.glsl")
            INPUT(0, uint, numbers)
            bool holds(uint i) { return (numbers(i) & 1u) == 1u; }
        };
        // Draw i goes to destination x of the i-th pair, if that exists.
        struct to_place {
            struct Params {
                uint unused;
            };
            TEST_KERNEL("to_place.glsl")
            INPUT(0, uvec2, pairs)
            INPUT(1, vec4, amounts)
            OUTPUT(0, uint, destination)
            OUTPUT(1, uint, payload)
            OUTPUT(2, vec4, amount)
            void kernel(uint i)
            {
                destination = pairs(i).x;
                payload = pairs(i).y;
                amount = amounts(i);
            }
        };
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
#include <photongrid/backend/end.hpp>
    } // namespace test_kernels

    constexpr text_file test_texts[] = {
        kernel_texts::grid,
        {"tests/next_frame.glsl", R"glsl(struct Params {
    uint stride;
};
PARAMS(Params)
INPUT(0, uvec2, frames)
OUTPUT(0, uvec2, frame)
void kernel(uint i) { frame = frames(i - args.stride) + uvec2(1u, i); }
)glsl"},
        {"tests/eight.glsl", R"glsl(struct Params {
    uint add;
};
PARAMS(Params)
SWITCH(1, DOUBLED)
INPUT(0, float, in0)
INPUT(1, vec2, in1)
INPUT(2, vec4, in2)
INPUT(3, uint, in3)
INPUT(4, uvec2, in4)
INPUT(5, uvec4, in5)
INPUT(6, uint, in6)
INPUT(7, uint, in7)
STATE(0, float, s0)
STATE(1, vec2, s1)
STATE(2, vec4, s2)
STATE(3, uint, s3)
STATE(4, uvec2, s4)
STATE(5, uvec4, s5)
STATE(6, uint, s6)
STATE(7, uint, left)
bool done() { return left == 0u; }
void kernel(uint i)
{
    s0 += in0(i);
    s1 += in1(i);
    s2 += in2(i);
    s3 += in3(i) + args.add;
    s4 += in4(i);
    s5 += in5(i);
    s6 += in6(i) + in7(i);
    left -= 1u;
    if (DOUBLED)
        s6 += 1000u;
}
)glsl"},
        {"tests/is_odd.glsl", R"glsl(struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uint, numbers)
bool holds(uint i) { return (numbers(i) & 1u) == 1u; }
)glsl"},
        {"tests/to_place.glsl", R"glsl(struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uvec2, pairs)
INPUT(1, vec4, amounts)
OUTPUT(0, uint, destination)
OUTPUT(1, uint, payload)
OUTPUT(2, vec4, amount)
void kernel(uint i)
{
    destination = pairs(i).x;
    payload = pairs(i).y;
    amount = amounts(i);
}
)glsl"},
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
