// The kernels of tests/core/verbs, with which verb_tests.hpp tests a backend. Each carries its text, so that no
// backend has to be told of them.
#pragma once

#include <photongrid/backend_tests/verb_kernel_text.hpp>
#include <photongrid/core/kernel.hpp>

#include <span>

#include <photongrid/core/begin.hpp>
namespace photongrid::verb_kernels {
using namespace glm; // kernels are GLSL: its names are GLM's

struct carries_text {
    static constexpr std::span<const text_file> own_texts() { return verb_kernel_texts; }
};
struct shifted : carries_text {
#include "verbs/shifted.glsl"
};
struct frame_below : carries_text {
#include "verbs/frame_below.glsl"
};
struct stirred : carries_text {
#include "verbs/stirred.glsl"
};
struct mixed : carries_text {
#include "verbs/mixed.glsl"
};
struct running_total : carries_text {
#include "verbs/running_total.glsl"
};
struct switched : carries_text {
#include "verbs/switched.glsl"
};
struct parameters : carries_text {
#include "verbs/parameters.glsl"
};
struct countdown : carries_text {
#include "verbs/countdown.glsl"
};
struct is_marked : carries_text {
#include "verbs/is_marked.glsl"
};
struct delivery : carries_text {
#include "verbs/delivery.glsl"
};
} // namespace photongrid::verb_kernels
#include <photongrid/core/end.hpp>
