// Cylinders.
#pragma once

#include <photongrid/scene/quadric.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The side of a cylinder, open at both ends.
struct cylinder {
    dvec3 base{0};              ///< m; the centre of one end
    dvec3 top{0, 1, 0};         ///< m; the centre of the other
    double radius = 1;          ///< m, above 0
    std::uint32_t material = 0; ///< index into scene::materials

    bool operator==(const cylinder&) const = default;
};

/// \throws std::invalid_argument for ends that coincide or are not finite, or a radius that is not above 0.
inline void check(const cylinder& x)
{
    detail::require_axis(x.base, x.top, "base and top");
    detail::require_radius(x.radius);
}

/// The shape_kind of cylinders.
template <>
struct shape_kind<cylinder> {
    static constexpr const char* name = "cylinder";                 ///< in scene files
    static constexpr const char* list = "cylinders";                ///< member of scene
    static constexpr std::uint32_t number = detail::quadric_number; ///< intersect/quadric.glsl
    static constexpr std::tuple fields{field{"base", &cylinder::base, quantity::point},
        field{"top", &cylinder::top, quantity::point},
        field{"radius", &cylinder::radius, quantity::length}}; ///< all fields

    /// \name See shape_kind
    /// @{
    static void add_bounds(bounds& b, const cylinder& x)
    {
        b.add(x.base, detail::disc_extent(x.top - x.base, x.radius));
        b.add(x.top, detail::disc_extent(x.top - x.base, x.radius));
    }
    static double size(const cylinder& x) { return x.radius; }
    static double round_size(const cylinder& x) { return detail::quadric_size(x.top - x.base, x.radius); }
    static double extent(const cylinder& x) { return glm::length(x.top - x.base); }
    static void write(record_writer& w, const cylinder& x)
    {
        detail::put_quadric(w, x.base, x.top, {.c = -x.radius * x.radius}, x.material);
    }
    /// @}
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
