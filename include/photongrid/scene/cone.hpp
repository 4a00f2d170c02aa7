// Cones.
#pragma once

#include <photongrid/scene/quadric.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The side of a cone, open at its base.
struct cone {
    dvec3 base{0};              ///< m; the centre of the open end
    dvec3 apex{0, 1, 0};        ///< m; the tip
    double radius = 1;          ///< m, above 0; at the base
    std::uint32_t material = 0; ///< index into scene::materials

    bool operator==(const cone&) const = default;
};

/// \throws std::invalid_argument for a base and an apex that coincide or are not finite, or a radius that is not above
///         0.
inline void check(const cone& x)
{
    detail::require_axis(x.base, x.apex, "base and apex");
    detail::require_radius(x.radius);
}

/// The shape_kind of cones.
template <>
struct shape_kind<cone> {
    static constexpr const char* name = "cone";                     ///< in scene files
    static constexpr const char* list = "cones";                    ///< member of scene
    static constexpr std::uint32_t number = detail::quadric_number; ///< intersect/quadric.glsl
    static constexpr std::tuple fields{field{"base", &cone::base, quantity::point},
        field{"apex", &cone::apex, quantity::point}, field{"radius", &cone::radius, quantity::length}}; ///< all fields

    /// \name See shape_kind
    /// @{
    static void add_bounds(bounds& b, const cone& x)
    {
        b.add(x.base, detail::disc_extent(x.apex - x.base, x.radius));
        b.add(x.apex);
    }
    static double size(const cone& x) { return x.radius; }
    static double round_size(const cone& x) { return detail::quadric_size(x.apex - x.base, x.radius); }
    static double extent(const cone& x) { return glm::length(x.apex - x.base); }
    static void write(record_writer& w, const cone& x)
    {
        // With z from the apex on, radius z/h, the equation has no constants that cancel.
        const double h = extent(x);
        detail::put_quadric(w, x.apex, x.base, {.a = -x.radius * x.radius / (h * h)}, x.material);
    }
    /// @}
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
