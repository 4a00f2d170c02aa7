// Paraboloids.
#pragma once

#include <photongrid/scene/quadric.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A paraboloid of revolution from its vertex to its rim, open at the rim.
struct paraboloid {
    dvec3 vertex{0};            ///< m; the deepest point
    dvec3 rim{0, 1, 0};         ///< m; centre of the rim
    double radius = 1;          ///< m, above 0; of the rim
    std::uint32_t material = 0; ///< index into scene::materials

    bool operator==(const paraboloid&) const = default;
};

/// \throws std::invalid_argument for a vertex and a rim that coincide or are not finite, or a radius that is not above
///         0.
inline void check(const paraboloid& x)
{
    detail::require_axis(x.vertex, x.rim, "vertex and rim");
    detail::require_radius(x.radius);
}

/// The shape_kind of paraboloids.
template <>
struct shape_kind<paraboloid> {
    static constexpr const char* name = "paraboloid";               ///< in scene files
    static constexpr const char* list = "paraboloids";              ///< member of scene
    static constexpr std::uint32_t number = detail::quadric_number; ///< intersect/quadric.glsl
    static constexpr std::tuple fields{field{"vertex", &paraboloid::vertex, quantity::point},
        field{"rim", &paraboloid::rim, quantity::point},
        field{"radius", &paraboloid::radius, quantity::length}}; ///< all fields

    /// \name See shape_kind
    /// @{
    static void add_bounds(bounds& b, const paraboloid& x)
    {
        const double height = extent(x);
        // How far it reaches from the vertex in a direction at this cosine to the axis: to the rim, or where that looks
        // the other way, to where z times the cosine plus the radius at z times the sine is greatest.
        const auto reach = [&](double cosine) {
            const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)), r = x.radius;
            const double z
                = cosine < 0 ? std::min(height, r * r * sine * sine / (4 * height * cosine * cosine)) : height;
            return z * cosine + r * std::sqrt(z / height) * sine;
        };
        const dvec3 axis = (x.rim - x.vertex) / height;
        b.add(x.vertex + dvec3(reach(axis.x), reach(axis.y), reach(axis.z)));
        b.add(x.vertex - dvec3(reach(-axis.x), reach(-axis.y), reach(-axis.z)));
    }
    static double size(const paraboloid& x) { return x.radius; }
    static double round_size(const paraboloid& x) { return detail::quadric_size(x.rim - x.vertex, x.radius); }
    static double extent(const paraboloid& x) { return glm::length(x.rim - x.vertex); }
    static void write(record_writer& w, const paraboloid& x)
    {
        // radius^2 z/h
        detail::put_quadric(w, x.vertex, x.rim, {.b = -x.radius * x.radius / extent(x)}, x.material);
    }
    /// @}
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
