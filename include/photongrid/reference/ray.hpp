// Rays and hits of the reference renderer: double precision, nothing shared with the kernels.
//
// A ray knows the shape it starts on. A plane is then not asked again, and of a round shape's two roots the one at the
// start is known to be 0, which leaves the other one exactly; so no ray needs to start off its surface.
#pragma once

#include <photongrid/scene/scene.hpp>

#include <array>
#include <limits>

#include <photongrid/backend/exact_begin.hpp>

/// The parts of the reference renderer (docs/reference/reference_renderer.md): double precision, m, W.
namespace photongrid::reference {

constexpr std::uint32_t nothing = 0xFFFFFFFFu;                       ///< no shape, no material, no light
constexpr double infinity = std::numeric_limits<double>::infinity(); ///< the distance of what is not met

/// Where a ray begins and where it goes.
struct ray {
    dvec3 origin{0};              ///< m
    dvec3 direction{0, 0, 1};     ///< unit
    std::uint32_t from = nothing; ///< the shape on which the origin lies
};

/// What a ray meets first.
struct hit {
    double t = infinity;              ///< along the ray, m; infinity: nothing is met
    std::uint32_t shape = nothing;    ///< number in `geometry`
    std::uint32_t material = nothing; ///< index into scene::materials; `nothing` for a light's surface
    std::uint32_t light = nothing;    ///< index into geometry::lights()
    dvec3 position{0};                ///< moved onto the surface
    dvec3 normal{0, 0, 1};            ///< unit; outward, or as the shape was given
};

/// A unit vector at right angles to n.
inline dvec3 across(const dvec3& n)
{
    const dvec3 a = glm::abs(n);
    const dvec3 least = a.x <= a.y && a.x <= a.z ? dvec3(1, 0, 0) : a.y <= a.z ? dvec3(0, 1, 0) : dvec3(0, 0, 1);
    return glm::normalize(glm::cross(n, least));
}

/// The real roots of a t^2 + 2 b t + c = 0; infinity for one that is not there. `starts_on`: c is 0 but for rounding,
/// and the root that is then 0 is left out.
inline std::array<double, 2> real_roots(double a, double b, double c, bool starts_on)
{
    const auto kept = [](double root) { return std::isfinite(root) ? root : infinity; };
    if (starts_on)
        return {kept(-2 * b / a), infinity};
    const double discriminant = b * b - a * c;
    if (!(discriminant >= 0))
        return {infinity, infinity};
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    return {kept(q / a), kept(c / q)};
}

} // namespace photongrid::reference

#include <photongrid/backend/exact_end.hpp>
