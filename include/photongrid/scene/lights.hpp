// Lights at a point, and of rectangles and meshes.
#pragma once

#include <photongrid/scene/bounds.hpp>
#include <photongrid/scene/light_power.hpp>
#include <photongrid/scene/placed_mesh.hpp>
#include <photongrid/scene/polygon.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A point light, which emits its power (W, rgb) uniformly in all directions.
struct point_light {
    std::string name;  ///< for messages
    dvec3 position{0}; ///< m
    dvec3 power{1};    ///< W, rgb; no channel is negative, at least one is positive

    bool operator==(const point_light&) const = default;
};

/// A rectangle that emits its power (W, rgb) diffusely on the side of cross(edge_u, edge_v). Its surface is black.
struct rectangle_light {
    std::string name;      ///< for messages
    dvec3 corner{0};       ///< m
    dvec3 edge_u{1, 0, 0}; ///< m; from the corner
    dvec3 edge_v{0, 0, 1}; ///< m; from the corner, at a right angle to edge_u
    dvec3 power{1};        ///< W, rgb; no channel is negative, at least one is positive

    bool operator==(const rectangle_light&) const = default;
};

/// A mesh that emits its power (W, rgb) diffusely and evenly over its area, on the outside of its triangles. It is
/// black.
struct mesh_light {
    std::string name;    ///< for messages
    placed_mesh surface; ///< its material and its vertices' normals have no meaning
    dvec3 power{1};      ///< W, rgb; no channel is negative, at least one is positive

    bool operator==(const mesh_light&) const = default;
};

/// \throws std::invalid_argument for a position that is not finite, or a power as in check_emission.
inline void check(const point_light& l)
{
    detail::require(detail::finite(l.position), "position: must be finite");
    check_emission("power", l.power);
}
/// \throws std::invalid_argument for members that are not finite, edges without area or not at right angles, or a power
///         as in check_emission.
inline void check(const rectangle_light& l)
{
    detail::require(detail::finite(l.corner) && detail::finite(l.edge_u) && detail::finite(l.edge_v),
        "corner, edge_u, edge_v: must be finite");
    const double u = glm::length(l.edge_u), v = glm::length(l.edge_v);
    detail::require(u > 0 && v > 0 && glm::length(glm::cross(l.edge_u, l.edge_v)) > 1e-9 * u * v,
        "edge_u, edge_v: the rectangle has no area");
    detail::require(std::abs(glm::dot(l.edge_u, l.edge_v)) <= 1e-6 * u * v, "edge_u, edge_v: must be at right angles");
    check_emission("power", l.power);
}

/// \throws std::invalid_argument for a surface that check() rejects or that has no area, or a power as in
///         check_emission.
inline void check(const mesh_light& l)
{
    check(l.surface);
    detail::require(area_of(l.surface) > 0, "triangles: the light has no area");
    check_emission("power", l.power);
}

/// The surface of a light.
inline polygon surface_of(const rectangle_light& l)
{
    return {{l.corner, l.corner + l.edge_u, l.corner + l.edge_u + l.edge_v, l.corner + l.edge_v}, 0};
}

/// The light_kind of point lights.
template <>
struct light_kind<point_light> {
    static constexpr const char* name = "point";        ///< in scene files
    static constexpr const char* list = "point_lights"; ///< member of scene
    static constexpr std::tuple fields{field{"position", &point_light::position, quantity::point},
        field{"power", &point_light::power, quantity::power}}; ///< all fields but the name
    static constexpr std::uint32_t number = 6;                 ///< its SWITCH: trace/lights/point_light.glsl
    static constexpr std::uint32_t switches = 1u << number;    ///< of kernels
    static constexpr auto samples = light_samples::once;

    /// \name See light_kind
    /// @{
    static void add_bounds(bounds& b, const point_light& l) { b.add(l.position); }
    static void write_record(record_writer& w, const point_light& l, const light_context&)
    {
        w.put_position(l.position, 0);
        w.put(dvec3(0), 0);
        w.put(dvec3(0), 0);
        w.put(dvec3(0), 0);
    }
    /// @}
};

/// The light_kind of rectangle lights.
template <>
struct light_kind<rectangle_light> {
    static constexpr const char* name = "rectangle";        ///< in scene files
    static constexpr const char* list = "rectangle_lights"; ///< member of scene
    static constexpr std::tuple fields{field{"corner", &rectangle_light::corner, quantity::point},
        field{"edge_u", &rectangle_light::edge_u, quantity::edge},
        field{"edge_v", &rectangle_light::edge_v, quantity::edge},
        field{"power", &rectangle_light::power, quantity::power}}; ///< all fields but the name
    static constexpr std::uint32_t number = 7;                     ///< its SWITCH: trace/lights/rectangle_light.glsl
    static constexpr std::uint32_t switches = 1u << number | 1u << shape_kind<polygon>::number; ///< of kernels
    static constexpr auto samples = light_samples::by_area;

    /// \name See light_kind
    /// @{
    static void add_bounds(bounds& b, const rectangle_light& l)
    {
        for (const auto& corner : surface_of(l).vertices)
            b.add(corner);
    }
    static double size(const rectangle_light& l) { return std::min(glm::length(l.edge_u), glm::length(l.edge_v)); }
    static double extent(const rectangle_light& l) { return size(l); }
    static void write_record(record_writer& w, const rectangle_light& l, const light_context&)
    {
        const dvec3 normal = glm::cross(l.edge_u, l.edge_v);
        w.put_position(l.corner, 1 / (std::numbers::pi * glm::length(normal)));
        w.put(l.edge_u, 0);
        w.put(l.edge_v, 0);
        w.put(glm::normalize(normal), glm::length(normal));
    }
    static light_ball ball(const glm::vec4* record)
    {
        const dvec3 u = detail::vector_of(record[2]), v = detail::vector_of(record[3]);
        return {detail::vector_of(record[1]) + 0.5 * (u + v), 0.5 * std::hypot(glm::length(u), glm::length(v))};
    }
    /// @}
};

/// The light_kind of mesh lights.
template <>
struct light_kind<mesh_light> {
    static constexpr const char* name = "mesh_light";                                        ///< in scene files
    static constexpr const char* list = "mesh_lights";                                       ///< member of scene
    static constexpr std::tuple fields{field{"power", &mesh_light::power, quantity::power}}; ///< but for the surface
    static constexpr std::uint32_t number = 11;                       ///< its SWITCH: trace/lights/mesh_light.glsl
    static constexpr std::uint32_t switches = 1u << number | 1u << 9; ///< of kernels
    static constexpr auto samples = light_samples::by_area;

    /// \name See light_kind
    /// @{
    static void add_bounds(bounds& b, const mesh_light& l) { shape_kind<placed_mesh>::add_bounds(b, l.surface); }
    static double size(const mesh_light& l) { return shape_kind<placed_mesh>::size(l.surface); }
    static void write_record(record_writer& w, const mesh_light& l, const light_context& in)
    {
        const std::size_t count = l.surface.surface->triangles.size();
        bounds box;
        add_bounds(box, l);
        w.put_position(0.5 * (box.low + box.high), 1 / (std::numbers::pi * area_of(l.surface)));
        w.put(dvec3(halves_of(in.first_triangle), 0), 0);
        w.put(dvec3(halves_of(count), 0), 0);
        w.put(dvec3(0.5 * glm::length(box.high - box.low), 0, 0), 0);
    }
    static light_ball ball(const glm::vec4* record)
    {
        return {detail::vector_of(record[1]), static_cast<double>(record[4].x)};
    }
    /// @}
};

namespace detail {
    /// Whether no lamp stands before another by more than `least`, m: then none blocks light on its way from another.
    /// False also where it would take long to find out: of thousands of lamps that face thousands of ways.
    inline bool lamps_block_none(const std::vector<rectangle_light>& lamps, double least)
    {
        std::vector<dvec3> corners;
        for (const auto& lamp : lamps)
            for (const auto& corner : surface_of(lamp).vertices)
                corners.push_back(corner);
        std::map<std::array<double, 3>, double> reach; // by normals: how far corners lie along them at most
        for (const auto& lit : lamps) {
            const dvec3 n = glm::normalize(glm::cross(lit.edge_u, lit.edge_v));
            const auto [found, is_new] = reach.try_emplace({n.x, n.y, n.z}, -std::numeric_limits<double>::infinity());
            if (is_new) {
                if (reach.size() * corners.size() > 1u << 24)
                    return false;
                for (const auto& corner : corners)
                    found->second = std::max(found->second, glm::dot(n, corner));
            }
            if (found->second - glm::dot(n, lit.corner) > least)
                return false;
        }
        return true;
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
