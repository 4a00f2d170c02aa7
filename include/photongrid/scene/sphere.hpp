// Spheres.
#pragma once

#include <photongrid/scene/bounds.hpp>
#include <photongrid/scene/fields.hpp>
#include <photongrid/scene/record_writer.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A sphere. Lengths in m here and in all shapes; `material` is an index into scene::materials.
struct sphere {
    dvec3 center{0};            ///< m
    double radius = 1;          ///< m, above 0
    std::uint32_t material = 0; ///< index into scene::materials

    bool operator==(const sphere&) const = default;
};

/// \throws std::invalid_argument for a centre that is not finite, or a radius that is not above 0.
inline void check(const sphere& s)
{
    detail::require(detail::finite(s.center), "center: must be finite");
    detail::require_radius(s.radius);
}

/// Whether two spheres overlap; touching does not count.
inline bool overlaps(const sphere& a, const sphere& b)
{
    return glm::length(a.center - b.center) < (a.radius + b.radius) * (1 - 1e-9);
}

/// The shape_kind of spheres.
template <>
struct shape_kind<sphere> {
    static constexpr const char* name = "sphere";  ///< in scene files
    static constexpr const char* list = "spheres"; ///< member of scene
    static constexpr std::uint32_t number = 0;     ///< intersect/sphere.glsl
    static constexpr std::tuple fields{field{"center", &sphere::center, quantity::point},
        field{"radius", &sphere::radius, quantity::length}}; ///< all fields

    /// \name See shape_kind
    /// @{
    static void add_bounds(bounds& b, const sphere& s) { b.add(s.center, dvec3(s.radius)); }
    static double size(const sphere& s) { return s.radius; }
    static double round_size(const sphere& s) { return 2 * s.radius; }
    /// `light`: 1 + number of the light whose surface it is, or 0.
    static void write(record_writer& w, const sphere& s, std::size_t light = 0)
    {
        w.put_position(s.center, s.radius);
        w.put(dvec3(s.material, static_cast<double>(light), 0), 0);
    }
    /// @}
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
