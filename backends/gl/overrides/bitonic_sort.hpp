// The OpenGL backend's bitonic sort: two pairs per texel, and up to three steps of the network per pass.
#pragma once

#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/map/bitonic_sort.hpp>

#include <photongrid/core/begin.hpp>
namespace photongrid::gl::kernels {

using namespace glm; // GLSL's types and functions

#include <photongrid/backends/gl/overrides/two_pairs.glsl>

struct pack_pairs {
#include <photongrid/backends/gl/overrides/pack_pairs.glsl>
};
struct bitonic_texels {
#include <photongrid/backends/gl/overrides/bitonic_texels.glsl>
};
struct unpack_pairs {
#include <photongrid/backends/gl/overrides/unpack_pairs.glsl>
};

} // namespace photongrid::gl::kernels
#include <photongrid/core/end.hpp>

namespace photongrid {

/// Sorts pairs in the same order as the generic bitonic_sort, in 102 passes over half as many texels instead of 210
/// passes for 1,048,576 pairs. While it runs it needs two more buffers of n pairs, rounded up to a power of two.
inline sort_report bitonic_sort(gl_backend& device, gl_backend::buffer<glm::uvec2>& pairs)
{
    const std::size_t n = pairs.size();
    sort_report report;
    if (n < 2)
        return report;
    const std::size_t padded = std::bit_ceil(n), texels = padded / 2;
    const auto levels = static_cast<uint>(std::countr_zero(padded));
    report.steps = levels * (levels + 1) / 2;
    auto now = device.make<glm::uvec4>(texels);
    device.run<gl::kernels::pack_pairs>(texels, {.pairs = static_cast<uint>(n)}, reads(pairs), writes(now));
    ++report.passes;
    {
        auto next = device.make<glm::uvec4>(texels);
        for (std::size_t run = 2; run <= texels; run *= 2)
            for (std::size_t stride = run / 2; stride > 0;) {
                // Two strides per pass; if their number is odd, the last one alone.
                const bool two = stride > 1, last = stride <= 2;
                const launch l(texels, 0, (two ? 1u : 0u) | (last ? 2u : 0u));
                device.run<gl::kernels::bitonic_texels>(
                    l, {.run = static_cast<uint>(run), .stride = static_cast<uint>(stride)}, reads(now), writes(next));
                std::swap(now, next);
                ++report.passes;
                stride /= two ? 4 : 2;
            }
    }
    device.run<gl::kernels::unpack_pairs>(n, {}, reads(now), writes(pairs));
    ++report.passes;
    return report;
}

} // namespace photongrid
