// Meshes that are placed in a scene.
#pragma once

#include <photongrid/scene/bounds.hpp>
#include <photongrid/scene/fields.hpp>
#include <photongrid/scene/mesh.hpp>

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <memory>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A mesh in a scene. Several may share one surface. If it is of glass, it must be closed, with the corners of each
/// triangle counterclockwise as seen from outside.
struct placed_mesh {
    std::string file;                    ///< that the surface was read from; empty: none
    std::shared_ptr<const mesh> surface; ///< not null; it must not change any more
    glm::dmat3 linear{1};                ///< scales and turns the surface's vertices ...
    dvec3 offset{0};                     ///< ... and then moves them, m
    std::uint32_t material = 0;          ///< index into scene::materials

    bool operator==(const placed_mesh& other) const
    {
        return file == other.file && linear == other.linear && offset == other.offset && material == other.material
            && (surface == other.surface || (surface && other.surface && *surface == *other.surface));
    }
};

/// The place of a vertex of the surface in the scene, m.
inline dvec3 place_of(const placed_mesh& m, const glm::vec3& vertex)
{
    return m.linear * (dvec3(vertex) + m.surface->origin) + m.offset;
}

/// Whether the placement exchanges inside and outside, as a mirror does.
inline bool is_mirrored(const placed_mesh& m) { return glm::determinant(m.linear) < 0; }

/// The corners of a triangle in the scene, m. Where `linear` mirrors the surface, the last two are exchanged, so that
/// its outside stays outside.
inline std::array<dvec3, 3> corners_of(const placed_mesh& m, std::size_t triangle)
{
    const auto of = corners_of(*m.surface, triangle);
    std::array<dvec3, 3> placed{place_of(m, of[0]), place_of(m, of[1]), place_of(m, of[2])};
    if (is_mirrored(m))
        std::swap(placed[1], placed[2]);
    return placed;
}

/// The area of a triangle, m^2.
inline double area_of(const std::array<dvec3, 3>& corners)
{
    return 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
}
/// The area of all triangles of a mesh, m^2.
inline double area_of(const placed_mesh& m)
{
    double area = 0;
    for (std::size_t t = 0; t < m.surface->triangles.size(); ++t)
        area += area_of(corners_of(m, t));
    return area;
}

/// The direction of a vertex's normal in the scene: a unit vector, or 0 for a normal of length 0.
inline dvec3 normal_of(const placed_mesh& m, const glm::vec3& normal)
{
    // The cofactors of `linear`: its inverse transposed, times the determinant, whose sign is that of mirroring.
    const auto& l = m.linear;
    const glm::dmat3 cofactors(glm::cross(l[1], l[2]), glm::cross(l[2], l[0]), glm::cross(l[0], l[1]));
    const dvec3 n = cofactors * dvec3(normal) * (is_mirrored(m) ? -1.0 : 1.0);
    const double length = glm::length(n);
    return length > 0 ? n / length : dvec3(0);
}

/// \throws std::invalid_argument for a mesh without surface or triangles, a surface that check() rejects, or a
///         placement that is not finite or leaves no volume.
inline void check(const placed_mesh& m)
{
    detail::require(m.surface != nullptr, "surface: there is none");
    detail::require(!m.surface->triangles.empty(), "triangles: the mesh has none");
    check(*m.surface);
    detail::require(detail::finite(m.linear[0]) && detail::finite(m.linear[1]) && detail::finite(m.linear[2])
            && detail::finite(m.offset),
        "matrix: must be finite");
    detail::require(std::abs(glm::determinant(m.linear))
            > 1e-12 * glm::length(m.linear[0]) * glm::length(m.linear[1]) * glm::length(m.linear[2]),
        "matrix: makes the mesh flat; scale it by more than 0 along each axis");
}

/// What of a shape_kind meshes have: kernels search them in another way, so they are in no table of theirs.
template <>
struct shape_kind<placed_mesh> {
    static constexpr const char* name = "mesh";                                                    ///< in scene files
    static constexpr const char* list = "meshes";                                                  ///< member of scene
    static constexpr std::tuple fields{field{"translate", &placed_mesh::offset, quantity::point}}; ///< what moves it

    /// Adds the corners of its triangles.
    static void add_bounds(bounds& b, const placed_mesh& m)
    {
        for (std::size_t t = 0; t < m.surface->triangles.size(); ++t)
            for (const auto& c : corners_of(*m.surface, t))
                b.add(place_of(m, c));
    }
    /// The diagonal of its box, m.
    static double size(const placed_mesh& m)
    {
        bounds b;
        add_bounds(b, m);
        return glm::length(b.high - b.low);
    }
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
