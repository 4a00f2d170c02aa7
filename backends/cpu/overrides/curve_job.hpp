// The parameters of the SIMD code for block maps: plain pointers, because it is compiled once per instruction set.
#pragma once

#include <photongrid/backends/cpu/buffer.hpp>
#include <photongrid/map/map_buffers.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::cpu {

/// Positions to order along a curve.
struct curve_job {
    kernels::Curve curve{};
    uint words = 0; ///< of the curve
    const glm::vec4* positions = nullptr;
    const glm::vec4* powers = nullptr; ///< null: query points, which have none
    uint parts = every_part;           ///< parts of the light
};

/// What begin_order() finds of a range of photons.
struct curve_summary {
    glm::vec3 low{3e38f}, high{-3e38f}; ///< their box, m; as kernels::low_of_nothing() where there are none
    uint ordered = 0;                   ///< how many get a place on the curve
    uint invalid = 0, left_out = 0;     ///< as in map_buffers

    curve_summary& operator|=(const curve_summary& other)
    {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
        ordered += other.ordered;
        invalid += other.invalid;
        left_out += other.left_out;
        return *this;
    }
};

} // namespace photongrid::cpu

#include <photongrid/core/exact_end.hpp>
