// Light from outside of the scene: of one direction, and of all.
#pragma once

#include <photongrid/scene/environment_map.hpp>
#include <photongrid/scene/fields.hpp>
#include <photongrid/scene/light_power.hpp>
#include <photongrid/scene/record_writer.hpp>

#include <glm/mat3x3.hpp>

#include <algorithm>
#include <memory>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Parallel light from infinitely far away, as from the sun.
struct directional_light {
    std::string name;          ///< for messages
    dvec3 direction{0, -1, 0}; ///< in which the light travels; of any length above 0
    dvec3 irradiance{1};       ///< W/m^2, rgb, of a surface that faces it; none negative, at least one positive

    bool operator==(const directional_light&) const = default;
};

/// Light from all directions, infinitely far away, as from the sky. The camera sees it where there is nothing else. A
/// scene has at most one.
struct environment_light {
    std::string name;                           ///< for messages
    std::string file;                           ///< that the map was read from; empty: none
    std::shared_ptr<const environment_map> map; ///< null: the same from everywhere; it must not change any more
    dvec3 radiance{1};   ///< W/(m^2 sr), rgb; the factor on the map's; none negative, at least one positive
    dvec3 axis{0, 1, 0}; ///< about which the map is turned; of any length above 0
    double degrees = 0;  ///< by which it is turned, counterclockwise as seen against the axis

    bool operator==(const environment_light& other) const
    {
        return name == other.name && file == other.file && radiance == other.radiance && axis == other.axis
            && degrees == other.degrees && (map == other.map || (map && other.map && *map == *other.map));
    }
};

/// \throws std::invalid_argument for a direction that is not finite or 0, or an irradiance as in check_emission.
inline void check(const directional_light& l)
{
    detail::require_direction(l.direction);
    check_emission("irradiance", l.irradiance);
}

/// \throws std::invalid_argument for a map that check() rejects, a radiance as in check_emission, or a rotation that is
///         not finite or whose axis is 0.
inline void check(const environment_light& l)
{
    check_emission("radiance", l.radiance);
    detail::require(detail::finite(l.axis) && glm::length(l.axis) > 0, "axis: must be finite and not 0");
    detail::require(detail::finite(l.degrees), "degrees: must be finite");
    if (l.map)
        check(*l.map);
}

/// The rotation of a vector about an axis, counterclockwise as seen against it (Rodrigues' formula).
inline glm::dmat3 rotation_about(const dvec3& axis, double degrees)
{
    const dvec3 a = glm::normalize(axis);
    const double angle = glm::radians(degrees);
    const glm::dmat3 cross(0, a.z, -a.y, -a.z, 0, a.x, a.y, -a.x, 0);
    return std::cos(angle) * glm::dmat3(1) + std::sin(angle) * cross + (1 - std::cos(angle)) * glm::outerProduct(a, a);
}

/// The texels of an environment as light is sampled from it: those of its map, divided so that a texel is small.
class environment_texels {
public:
    explicit environment_texels(const environment_light& l)
        : light_(l), map_(l.map ? *l.map : uniform()), split_u_((63 + map_.width) / map_.width),
          split_v_((31 + map_.height) / map_.height), turned_(rotation_about(l.axis, l.degrees))
    {
    }

    std::uint32_t width() const { return map_.width * split_u_; }
    std::uint32_t height() const { return map_.height * split_v_; }
    /// W/(m^2 sr), rgb.
    dvec3 radiance(std::uint32_t column, std::uint32_t row) const
    {
        return light_.radiance * dvec3(map_.radiance[std::size_t{row / split_v_} * map_.width + column / split_u_]);
    }
    /// The solid angle of each texel of a row, sr.
    double solid_angle(std::uint32_t row) const
    {
        const double pi = std::numbers::pi, top = pi * row / height(), bottom = pi * (row + 1) / height();
        return 2 * pi / width() * 2 * std::sin((bottom - top) / 2) * std::sin((bottom + top) / 2);
    }
    /// The direction in the scene to the middle of a texel, a unit vector.
    dvec3 direction(std::uint32_t column, std::uint32_t row) const
    {
        return turned_ * environment_direction((column + 0.5) / width(), (row + 0.5) / height());
    }

private:
    static const environment_map& uniform()
    {
        static const environment_map white;
        return white;
    }

    const environment_light& light_;
    const environment_map& map_;
    std::uint32_t split_u_, split_v_;
    glm::dmat3 turned_;
};

/// The light_kind of directional lights.
template <>
struct light_kind<directional_light> {
    static constexpr const char* name = "directional";        ///< in scene files
    static constexpr const char* list = "directional_lights"; ///< member of scene
    static constexpr std::tuple fields{field{"direction", &directional_light::direction, quantity::direction},
        field{"irradiance", &directional_light::irradiance, quantity::emission}}; ///< all fields but the name
    static constexpr std::uint32_t number = 14;             ///< its SWITCH: trace/lights/directional_light.glsl
    static constexpr std::uint32_t switches = 1u << number; ///< of kernels
    static constexpr auto samples = light_samples::once;

    /// \name See light_kind
    /// @{
    static void add_bounds(bounds&, const directional_light&) {}
    static dvec3 power_into(const bounds& box, const directional_light& l)
    {
        return l.irradiance * projected_area(box, glm::normalize(l.direction));
    }
    static void write_record(record_writer& w, const directional_light& l, const light_context& in)
    {
        const dvec3 d = glm::normalize(l.direction);
        w.put(d, 1 / projected_area(in.box, d));
        w.put_position(in.box.low, 0);
        w.put_position(in.box.high, 0);
        w.put(dvec3(0), 0);
    }
    /// @}
};

/// The light_kind of environments.
template <>
struct light_kind<environment_light> {
    static constexpr const char* name = "environment";        ///< in scene files
    static constexpr const char* list = "environment_lights"; ///< member of scene
    static constexpr std::tuple fields{
        field{"radiance", &environment_light::radiance, quantity::emission}}; ///< but for the map and its rotation
    static constexpr std::uint32_t number = 15;             ///< its SWITCH: trace/lights/environment_light.glsl
    static constexpr std::uint32_t switches = 1u << number; ///< of kernels
    static constexpr auto samples = light_samples::by_direction;

    /// \name See light_kind
    /// @{
    static void add_bounds(bounds&, const environment_light&) {}
    static dvec3 power_into(const bounds& box, const environment_light& l)
    {
        const environment_texels texels(l);
        dvec3 power(0);
        for (std::uint32_t row = 0; row < texels.height(); ++row)
            for (std::uint32_t column = 0; column < texels.width(); ++column)
                power += texels.radiance(column, row)
                    * (texels.solid_angle(row) * projected_area(box, texels.direction(column, row)));
        return power;
    }
    static void write_record(record_writer& w, const environment_light& l, const light_context& in)
    {
        const environment_texels texels(l);
        const double half = glm::radians(l.degrees) / 2;
        w.put(dvec3(texels.width(), texels.height(), 0), 0);
        w.put_position(in.box.low, 0);
        w.put_position(in.box.high, 0);
        w.put(std::sin(half) * glm::normalize(l.axis), std::cos(half));
    }
    /// @}
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
