// Boxes.
#pragma once

#include <photongrid/scene/polygon.hpp>
#include <photongrid/scene/sphere.hpp>

#include <algorithm>
#include <array>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A closed box in any orientation: a corner and the three edges from it. edge_correction does not apply to its faces.
struct box {
    dvec3 corner{0};            ///< m
    dvec3 edge_u{1, 0, 0};      ///< m; from the corner; the three edges are at right angles
    dvec3 edge_v{0, 1, 0};      ///< m
    dvec3 edge_w{0, 0, 1};      ///< m
    std::uint32_t material = 0; ///< index into scene::materials

    bool operator==(const box&) const = default;
};

/// \throws std::invalid_argument for a corner or an edge that is not finite, an edge of length 0, or edges that are not
/// at right angles.
inline void check(const box& b)
{
    const std::array edges{b.edge_u, b.edge_v, b.edge_w};
    detail::require(detail::finite(b.corner), "corner: must be finite");
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string name = i == 0 ? "edge_u" : i == 1 ? "edge_v" : "edge_w";
        detail::require(detail::finite(edges[i]) && glm::length(edges[i]) > 0, name + ": must be finite and not zero");
        detail::require(std::abs(glm::dot(edges[i], edges[(i + 1) % 3]))
                <= 1e-6 * glm::length(edges[i]) * glm::length(edges[(i + 1) % 3]),
            name + ": edge_u, edge_v and edge_w must be at right angles to each other");
    }
}

/// The faces of a box, normals outwards.
inline std::array<polygon, 6> faces_of(const box& b)
{
    const std::array edges{b.edge_u, b.edge_v, b.edge_w};
    std::array<polygon, 6> faces;
    const bool right_handed = glm::dot(glm::cross(edges[0], edges[1]), edges[2]) > 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        dvec3 u = edges[(axis + 1) % 3], v = edges[(axis + 2) % 3];
        if (!right_handed)
            std::swap(u, v);
        const dvec3 p = b.corner + edges[axis];
        faces[2 * axis] = {{b.corner, b.corner + v, b.corner + u + v, b.corner + u}, b.material};
        faces[2 * axis + 1] = {{p, p + u, p + u + v, p + v}, b.material};
    }
    return faces;
}

namespace detail {
    inline dvec3 middle_of(const box& b) { return b.corner + 0.5 * (b.edge_u + b.edge_v + b.edge_w); }

    /// Half the extent of a box along a unit vector, m.
    inline double extent_along(const box& b, const dvec3& n)
    {
        return 0.5
            * (std::abs(glm::dot(b.edge_u, n)) + std::abs(glm::dot(b.edge_v, n)) + std::abs(glm::dot(b.edge_w, n)));
    }
} // namespace detail

/// Whether two boxes overlap; touching does not count. Convex bodies are separate if a plane separates them, and for
/// boxes it is parallel to a face of one or to an edge of each.
inline bool overlaps(const box& a, const box& b)
{
    const dvec3 between = detail::middle_of(b) - detail::middle_of(a);
    const auto apart = [&](const dvec3& direction) {
        const double length = glm::length(direction);
        if (!(length > 1e-9)) // parallel edges: the planes of the faces suffice
            return false;
        const dvec3 n = direction / length;
        return std::abs(glm::dot(between, n)) >= (detail::extent_along(a, n) + detail::extent_along(b, n)) * (1 - 1e-9);
    };
    const std::array of_a{a.edge_u, a.edge_v, a.edge_w}, of_b{b.edge_u, b.edge_v, b.edge_w};
    for (const auto& e : of_a)
        for (const auto& f : of_b)
            if (apart(glm::normalize(e)) || apart(glm::normalize(f))
                || apart(glm::cross(glm::normalize(e), glm::normalize(f))))
                return false;
    return true;
}

/// The same for a box and a sphere.
inline bool overlaps(const box& b, const sphere& s)
{
    const dvec3 from_middle = s.center - detail::middle_of(b);
    double beyond2 = 0; // squared distance of the sphere's centre from the box, m^2
    for (const auto& e : {b.edge_u, b.edge_v, b.edge_w}) {
        const double half = 0.5 * glm::length(e);
        const double beyond = std::max(0.0, std::abs(glm::dot(from_middle, glm::normalize(e))) - half);
        beyond2 += beyond * beyond;
    }
    return std::sqrt(beyond2) < s.radius * (1 - 1e-9);
}

/// The shape_kind of boxes.
template <>
struct shape_kind<box> {
    static constexpr const char* name = "box";   ///< in scene files
    static constexpr const char* list = "boxes"; ///< member of scene
    static constexpr std::uint32_t number = 8;   ///< intersect/box.glsl
    static constexpr std::tuple fields{field{"corner", &box::corner, quantity::point},
        field{"edge_u", &box::edge_u, quantity::edge}, field{"edge_v", &box::edge_v, quantity::edge},
        field{"edge_w", &box::edge_w, quantity::edge}}; ///< all fields

    /// \name See shape_kind
    /// @{
    static void add_bounds(bounds& all, const box& b)
    {
        for (const auto& face : faces_of(b))
            shape_kind<polygon>::add_bounds(all, face);
    }
    static double extent(const box& b)
    {
        return std::min({glm::length(b.edge_u), glm::length(b.edge_v), glm::length(b.edge_w)});
    }
    static double size(const box& b) { return 0.5 * extent(b); }
    static double round_size(const box& b) { return glm::length(b.edge_u + b.edge_v + b.edge_w); }
    static std::uint64_t steps(const box&) { return 5; } // the closest hit, three pairs of faces, the loop's end
    static void write(record_writer& w, const box& b)
    {
        const dvec3 u = glm::normalize(b.edge_u), v = glm::normalize(b.edge_v - glm::dot(b.edge_v, u) * u);
        w.put(u, 0.5 * glm::length(b.edge_u));
        w.put(v, 0.5 * glm::length(b.edge_v));
        w.put(glm::cross(u, v), 0.5 * glm::length(b.edge_w));
        w.put_position(detail::middle_of(b), b.material);
    }
    /// @}
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
