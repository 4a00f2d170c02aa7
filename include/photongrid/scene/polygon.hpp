// Convex polygons.
#pragma once

#include <photongrid/scene/bounds.hpp>
#include <photongrid/scene/fields.hpp>
#include <photongrid/scene/record_writer.hpp>

#include <algorithm>
#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A convex, planar polygon, with its vertices in order around it.
struct polygon {
    std::vector<dvec3> vertices; ///< m; 3 or more
    std::uint32_t material = 0;  ///< index into scene::materials

    bool operator==(const polygon&) const = default;
};

/// The area vector of a polygon: along its normal, with its area, m^2, as length (Newell's method).
inline dvec3 area_vector(const polygon& p)
{
    dvec3 sum(0);
    for (std::size_t i = 0; i < p.vertices.size(); ++i)
        sum += glm::cross(p.vertices[i] - p.vertices[0], p.vertices[(i + 1) % p.vertices.size()] - p.vertices[0]);
    return 0.5 * sum;
}

/// The largest distance between the first vertex and another, m.
inline double extent(const polygon& p)
{
    double longest = 0;
    for (const auto& v : p.vertices)
        longest = std::max(longest, glm::length(v - p.vertices[0]));
    return longest;
}

namespace detail {
    /// The angle by which the edges turn about the normal n, from the first to the first again, radians. Edges shorter
    /// than `least`, whose directions may be rounding errors, do not count.
    inline double turn_of_edges(const polygon& p, const dvec3& n, double least)
    {
        double turn = 0;
        std::optional<dvec3> first, last;
        const auto add = [&](const dvec3& edge) {
            if (last)
                turn += std::atan2(glm::dot(n, glm::cross(*last, edge)), glm::dot(*last, edge));
            last = edge;
        };
        for (std::size_t i = 0; i < p.vertices.size(); ++i) {
            const dvec3 edge = p.vertices[(i + 1) % p.vertices.size()] - p.vertices[i];
            if (!(glm::length(edge) > least))
                continue;
            add(edge);
            first = first.value_or(edge);
        }
        if (first)
            add(*first);
        return turn;
    }
} // namespace detail

/// \throws std::invalid_argument for fewer than 3 vertices, one that is not finite or is off the plane by more than
/// 1e-5 of the polygon's extent, a polygon without area, or one that is not convex or winds around more than once.
inline void check(const polygon& p)
{
    detail::require(p.vertices.size() >= 3, "vertices: a polygon has at least 3");
    for (const auto& v : p.vertices)
        detail::require(detail::finite(v), "vertices: must be finite");
    const double longest = extent(p);
    const dvec3 area = area_vector(p);
    detail::require(glm::length(area) > 1e-12 * longest * longest, "vertices: the polygon has no area");
    const dvec3 n = glm::normalize(area);
    for (std::size_t i = 0; i < p.vertices.size(); ++i) {
        const auto& a = p.vertices[i];
        const auto& b = p.vertices[(i + 1) % p.vertices.size()];
        const auto& c = p.vertices[(i + 2) % p.vertices.size()];
        detail::require(std::abs(glm::dot(n, a - p.vertices[0])) <= 1e-5 * longest,
            "vertices: vertex " + std::to_string(i)
                + " lies off the plane of the others by more than 1e-5 of the polygon's extent; split it into "
                  "triangles");
        detail::require(glm::dot(n, glm::cross(b - a, c - b)) >= -1e-9 * longest * longest,
            "vertices: the polygon is not convex at vertex " + std::to_string((i + 1) % p.vertices.size()));
    }
    // Once around is 2 pi. A star turns to one side at all of its vertices too.
    detail::require(detail::turn_of_edges(p, n, 1e-4 * longest) < 9,
        "vertices: the polygon winds around more than once; list its vertices in order around it");
}

namespace detail {
    /// Writes a polygon, or the surface of light number `light` - 1.
    inline void put_polygon(record_writer& w, const polygon& p, std::size_t light)
    {
        const dvec3 n = glm::normalize(area_vector(p));
        w.put_plane(n, p.vertices[0]);
        const double rounding = w.rounding(p.vertices);
        double off = 0; // vertices may lie slightly off the plane
        for (const auto& v : p.vertices)
            off = std::max(off, std::abs(glm::dot(n, v - p.vertices[0])));
        w.put(
            dvec3(static_cast<double>(p.vertices.size()), p.material, static_cast<double>(light)), rounding + 2 * off);
        for (std::size_t i = 0; i < p.vertices.size(); ++i) {
            const auto& a = p.vertices[i];
            const auto& b = p.vertices[(i + 1) % p.vertices.size()];
            const dvec3 across = glm::cross(n, b - a); // into the polygon
            const double length = glm::length(across);
            const dvec3 inward = length > 0 ? across / length : dvec3(0);
            w.put(inward, glm::dot(inward, a - w.center()) - rounding); // inflated, so that neighbours overlap
        }
        for (const auto& v : p.vertices)
            w.put_position(v, 0);
    }
} // namespace detail

/// The shape_kind of polygons.
template <>
struct shape_kind<polygon> {
    static constexpr const char* name = "polygon";  ///< in scene files
    static constexpr const char* list = "polygons"; ///< member of scene
    static constexpr std::uint32_t number = 3;      ///< intersect/polygon.glsl
    static constexpr std::tuple fields{field{"vertices", &polygon::vertices, quantity::points}}; ///< all fields

    /// \name See shape_kind
    /// @{
    static void add_bounds(bounds& b, const polygon& p)
    {
        for (const auto& v : p.vertices)
            b.add(v);
    }
    static double size(const polygon& p) { return photongrid::extent(p); }
    static double round_size(const polygon&) { return 0; }
    static std::uint64_t steps(const polygon& p)
    {
        // The shaft, the closest hit, a half-space per edge, and at grazing incidence hit_at_edge with one round more;
        // each of the loops over edges has a round that only ends it.
        return 2 * std::uint64_t{p.vertices.size()} + 5;
    }
    static double extent(const polygon& p) { return photongrid::extent(p); }
    static void write(record_writer& w, const polygon& p, std::size_t light = 0) { detail::put_polygon(w, p, light); }
    /// @}
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
