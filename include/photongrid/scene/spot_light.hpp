// Spotlights.
#pragma once

#include <photongrid/scene/fields.hpp>
#include <photongrid/scene/light_power.hpp>
#include <photongrid/scene/record_writer.hpp>

#include <cmath>
#include <numbers>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A point light that shines into a cone. Its intensity (W/sr) is even up to `inner_angle` from the axis, and falls to
/// 0 at `outer_angle` as 3 t^2 - 2 t^3 does, where t is linear in the cosine of the angle.
struct spot_light {
    std::string name;          ///< for messages
    dvec3 position{0};         ///< m
    dvec3 direction{0, -1, 0}; ///< of the axis; of any length above 0
    double inner_angle = 30;   ///< degrees, from the axis, 0 to outer_angle
    double outer_angle = 45;   ///< degrees, from the axis, 0.01 to 180
    dvec3 power{1};            ///< W, rgb; no channel is negative, at least one is positive

    bool operator==(const spot_light&) const = default;
};

/// \throws std::invalid_argument for members that are not finite, a direction of length 0, angles that are not in
///         order, or a power as in check_emission.
inline void check(const spot_light& l)
{
    detail::require(detail::finite(l.position), "position: must be finite");
    detail::require_direction(l.direction);
    detail::require(l.inner_angle >= 0 && l.inner_angle <= 180, "inner_angle: must be from 0 to 180 degrees");
    detail::require(l.outer_angle >= 0.01 && l.outer_angle <= 180, "outer_angle: must be from 0.01 to 180 degrees");
    detail::require(l.inner_angle <= l.outer_angle, "inner_angle: must be at most outer_angle");
    check_emission("power", l.power);
}

namespace detail {
    /// 1 - cos of an angle in degrees, precise for small ones.
    inline double one_minus_cosine(double degrees)
    {
        const double half = std::sin(glm::radians(degrees) / 2);
        return 2 * half * half;
    }
} // namespace detail

/// The light_kind of spotlights.
template <>
struct light_kind<spot_light> {
    static constexpr const char* name = "spot";        ///< in scene files
    static constexpr const char* list = "spot_lights"; ///< member of scene
    static constexpr std::tuple fields{field{"position", &spot_light::position, quantity::point},
        field{"direction", &spot_light::direction, quantity::direction},
        field{"inner_angle", &spot_light::inner_angle, quantity::angle},
        field{"outer_angle", &spot_light::outer_angle, quantity::angle},
        field{"power", &spot_light::power, quantity::power}}; ///< all fields but the name
    static constexpr std::uint32_t number = 13;               ///< its SWITCH: trace/lights/spot_light.glsl
    static constexpr std::uint32_t switches = 1u << number;   ///< of kernels
    static constexpr auto samples = light_samples::once;

    /// \name See light_kind
    /// @{
    static void add_bounds(bounds& b, const spot_light& l) { b.add(l.position); }
    static void write_record(record_writer& w, const spot_light& l, const light_context&)
    {
        // Solid angles divided by 2 pi. The mean of 3 t^2 - 2 t^3 is 1/2.
        const double even = detail::one_minus_cosine(l.inner_angle),
                     fading = detail::one_minus_cosine(l.outer_angle) - even, lit = even + fading / 2;
        w.put_position(l.position, 0);
        w.put(glm::normalize(l.direction), 1 / (2 * std::numbers::pi * lit));
        w.put(dvec3(even, fading, even / lit), 0);
        w.put(dvec3(0), 0);
    }
    /// @}
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
