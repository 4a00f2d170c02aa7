// Surfaces of revolution with quadratic profiles, which share one shape of the kernels (trace/intersect/quadric.glsl).
#pragma once

#include <photongrid/scene/bounds.hpp>
#include <photongrid/scene/fields.hpp>
#include <photongrid/scene/record_writer.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// Their common shape_kind::number.
constexpr std::uint32_t quadric_number = 1;

/// The coefficients of x^2 + y^2 + a z^2 + b z + c = 0, with z along the axis from its first end.
struct quadric_profile {
    double a = 0, b = 0, c = 0;
};

/// Writes a quadric with an axis from `from` to `to`.
inline void put_quadric(
    record_writer& w, const dvec3& from, const dvec3& to, const quadric_profile& profile, std::uint32_t material)
{
    const double height = glm::length(to - from);
    const dvec3 axis = (to - from) / height;
    const dvec3 u = glm::normalize(glm::cross(std::abs(axis.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), axis));
    w.put_position(from, height);
    w.put(u, profile.a);
    w.put(glm::cross(axis, u), profile.b);
    w.put(axis, profile.c);
    w.put_number(material);
}

/// The shape_kind::round_size of a quadric with this axis.
inline double quadric_size(const dvec3& axis, double radius) { return 2 * (glm::length(axis) + radius); }

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
