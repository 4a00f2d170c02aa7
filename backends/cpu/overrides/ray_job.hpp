// The parameters of the SIMD code that searches for the hits of rays: plain pointers, because it is compiled once per
// instruction set.
#pragma once

#include <photongrid/backends/cpu/cpu_backend.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::cpu {

/// Rays and the triangles that they may hit.
struct ray_job {
    const float* nodes = nullptr; ///< see wide_tree.hpp
    const float* blocks = nullptr;
    const glm::vec4* planes = nullptr;
    glm::vec3 low{0}, high{0};             ///< box of all triangles, m
    const glm::uvec4* instances = nullptr; ///< see trace/instance.glsl; null: there are none
    const wide_root* roots = nullptr;      ///< of their surfaces
    bool any = false;                      ///< the first hit that is found is enough
    const glm::vec4* origins = nullptr;
    const glm::vec4* directions = nullptr;
    glm::uvec4* states = nullptr; ///< see trace/ray_state.glsl
};

} // namespace photongrid::cpu

#include <photongrid/core/exact_end.hpp>
