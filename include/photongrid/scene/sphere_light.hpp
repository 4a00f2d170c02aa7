// Spheres that are lights.
#pragma once

#include <photongrid/scene/light_power.hpp>
#include <photongrid/scene/sphere.hpp>

#include <numbers>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A sphere that emits its power (W, rgb) diffusely and evenly over its area, on its outside. It is black.
struct sphere_light {
    std::string name;  ///< for messages
    dvec3 center{0};   ///< m
    double radius = 1; ///< m, above 0
    dvec3 power{1};    ///< W, rgb; no channel is negative, at least one is positive

    bool operator==(const sphere_light&) const = default;
};

/// The surface of a light.
inline sphere surface_of(const sphere_light& l) { return {l.center, l.radius, 0}; }

/// \throws std::invalid_argument for a centre that is not finite, a radius that is not above 0, or a power as in
///         check_emission.
inline void check(const sphere_light& l)
{
    check(surface_of(l));
    check_emission("power", l.power);
}

/// The light_kind of sphere lights.
template <>
struct light_kind<sphere_light> {
    static constexpr const char* name = "sphere_light";  ///< in scene files
    static constexpr const char* list = "sphere_lights"; ///< member of scene
    static constexpr std::tuple fields{field{"center", &sphere_light::center, quantity::point},
        field{"radius", &sphere_light::radius, quantity::length},
        field{"power", &sphere_light::power, quantity::power}}; ///< all fields but the name
    static constexpr std::uint32_t number = 12;                 ///< its SWITCH: trace/lights/sphere_light.glsl
    static constexpr std::uint32_t switches = 1u << number | 1u << shape_kind<sphere>::number; ///< of kernels
    static constexpr auto samples = light_samples::by_solid_angle;

    /// \name See light_kind
    /// @{
    static void add_bounds(bounds& b, const sphere_light& l) { shape_kind<sphere>::add_bounds(b, surface_of(l)); }
    static double size(const sphere_light& l) { return l.radius; }
    static void write_record(record_writer& w, const sphere_light& l, const light_context&)
    {
        const double pi = std::numbers::pi;
        w.put_position(l.center, 1 / (4 * pi * pi * l.radius * l.radius));
        w.put(dvec3(l.radius, 0, 0), 0);
        w.put(dvec3(0), 0);
        w.put(dvec3(0), 0);
    }
    static light_ball ball(const glm::vec4* record)
    {
        return {detail::vector_of(record[1]), static_cast<double>(record[2].x)};
    }
    /// @}
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
