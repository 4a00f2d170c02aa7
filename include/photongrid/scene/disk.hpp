// Disks.
#pragma once

#include <photongrid/scene/bounds.hpp>
#include <photongrid/scene/fields.hpp>
#include <photongrid/scene/record_writer.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A flat, two-sided disk.
struct disk {
    dvec3 center{0};            ///< m
    dvec3 normal{0, 1, 0};      ///< of any length above 0
    double radius = 1;          ///< m, above 0
    std::uint32_t material = 0; ///< index into scene::materials

    bool operator==(const disk&) const = default;
};

/// \throws std::invalid_argument for a centre or normal that is not finite, a normal of length 0, or a radius that is
/// not above 0.
inline void check(const disk& d)
{
    detail::require(detail::finite(d.center), "center: must be finite");
    detail::require(detail::finite(d.normal) && glm::length(d.normal) > 0, "normal: must be finite and not zero");
    detail::require_radius(d.radius);
}

/// The shape_kind of disks.
template <>
struct shape_kind<disk> {
    static constexpr const char* name = "disk";  ///< in scene files
    static constexpr const char* list = "disks"; ///< member of scene
    static constexpr std::uint32_t number = 2;   ///< intersect/disk.glsl
    static constexpr std::tuple fields{field{"center", &disk::center, quantity::point},
        field{"normal", &disk::normal, quantity::direction},
        field{"radius", &disk::radius, quantity::length}}; ///< all fields

    /// \name See shape_kind
    /// @{
    static void add_bounds(bounds& b, const disk& d) { b.add(d.center, detail::disc_extent(d.normal, d.radius)); }
    static double size(const disk& d) { return d.radius; }
    static double round_size(const disk&) { return 0; }
    static void write(record_writer& w, const disk& d)
    {
        w.put_plane(glm::normalize(d.normal), d.center);
        w.put_position(d.center, d.radius);
        w.put_number(d.material);
    }
    /// @}
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
