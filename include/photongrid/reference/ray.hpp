// Rays and hits of the reference renderer: in double precision, independent of the kernels.
//
// A ray has the number of the shape that it starts on. It cannot hit that shape again if the shape is flat; if it is
// curved, one root is known to be 0, so the other one is exact. Therefore origins need no offset.
#pragma once

#include <photongrid/scene/scene.hpp>

#include <array>
#include <limits>

#include <photongrid/core/exact_begin.hpp>

/// The reference renderer (docs/reference/reference_renderer.md): double precision, m, W.
namespace photongrid::reference {

constexpr std::uint32_t nothing = 0xFFFFFFFFu;                       ///< no shape, material or light
constexpr double infinity = std::numeric_limits<double>::infinity(); ///< distance of a miss

/// A ray.
struct ray {
    dvec3 origin{0};              ///< m
    dvec3 direction{0, 0, 1};     ///< unit
    std::uint32_t from = nothing; ///< the shape that the origin lies on
};

/// The closest hit of a ray.
struct hit {
    double t = infinity;              ///< distance along the ray, m; infinity: a miss
    std::uint32_t shape = nothing;    ///< its number in `geometry`
    std::uint32_t material = nothing; ///< index into scene::materials; `nothing` for a light's surface
    std::uint32_t light = nothing;    ///< index into geometry::lights()
    dvec3 position{0};                ///< moved onto the surface
    dvec3 normal{0, 0, 1};            ///< unit; outward, or as the shape defines it
    dvec3 shading{0, 0, 1};           ///< the same, interpolated between a mesh's vertices if they have normals
    dvec3 color{1};                   ///< of vertices
    glm::dvec2 coordinates{0};        ///< of textures
};

/// A unit vector perpendicular to n.
inline dvec3 across(const dvec3& n)
{
    const dvec3 a = glm::abs(n);
    const dvec3 least = a.x <= a.y && a.x <= a.z ? dvec3(1, 0, 0) : a.y <= a.z ? dvec3(0, 1, 0) : dvec3(0, 0, 1);
    return glm::normalize(glm::cross(n, least));
}

/// The real roots of a t^2 + 2 b t + c = 0, or infinity. `starts_on`: c is 0 except for rounding, and the root 0 is
/// left out.
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

#include <photongrid/core/exact_end.hpp>
