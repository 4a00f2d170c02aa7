// Random directions, for the reference renderer.
#pragma once

#include <photongrid/reference/ray.hpp>

#include <cmath>
#include <numbers>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// The unit vector at `turn` radians about n whose part along n is `cosine`.
inline dvec3 around(const dvec3& n, double cosine, double turn)
{
    const dvec3 x = across(n), y = glm::cross(n, x);
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return glm::normalize(sine * std::cos(turn) * x + sine * std::sin(turn) * y + cosine * n);
}

/// A direction in the hemisphere about the unit vector n with density cos / pi, for u and v in [0, 1).
inline dvec3 cosine_direction(const dvec3& n, double u, double v)
{
    return around(n, std::sqrt(1 - u), 2 * std::numbers::pi * v);
}

/// A direction with density 1 / (4 pi), for u and v in [0, 1).
inline dvec3 uniform_direction(double u, double v) { return around({0, 0, 1}, 1 - 2 * u, 2 * std::numbers::pi * v); }

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
