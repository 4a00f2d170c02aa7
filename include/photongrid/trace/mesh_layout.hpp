// The triangles of a scene's meshes for kernels: faces, planes and normals, in single precision and recentred.
#pragma once

#include <photongrid/scene/placed_mesh.hpp>
#include <photongrid/trace/triangle_tree.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// The triangles of all meshes of a scene, in the meshes' order, as trace/mesh_surface.glsl describes them.
struct mesh_layout {
    mesh triangles;                 ///< recentred; without normals
    std::vector<glm::uvec4> faces;  ///< of each triangle: its vertices, its material, whether it has normals
    std::vector<glm::vec4> planes;  ///< of each triangle: unit normal; offset, m
    std::vector<glm::vec4> normals; ///< of each vertex; empty if no mesh has any
    std::vector<uint> shares;       ///< of each triangle of mesh lights, which come first: see trace/mesh_light.glsl
    /// Of each vertex two: texture coordinates and colour; empty if no mesh has any (trace/mesh_color.glsl).
    std::vector<glm::vec4> attributes;
    std::vector<glm::uvec2> texels; ///< of all textures
};

namespace detail {
    /// Appends meshes to a layout.
    class mesh_writer {
    public:
        /// `center` is subtracted from positions; `any_smooth`, `any_colored`: some mesh of the scene has normals,
        /// colours or texture coordinates.
        mesh_writer(mesh_layout& out, const dvec3& center, bool any_smooth, bool any_colored)
            : out_(out), center_(center), any_smooth_(any_smooth), any_colored_(any_colored)
        {
        }

        /// `code`: w of its faces (trace/mesh_surface.glsl).
        void write(const placed_mesh& m, uint code, bool smooth)
        {
            auto& all = out_;
            require_countable(all.triangles.triangles.size() + m.surface->triangles.size());
            const auto vertices = static_cast<uint>(all.triangles.positions.size());
            for (const auto& p : m.surface->positions)
                all.triangles.positions.emplace_back(place_of(m, p) - center_);
            if (any_smooth_) {
                if (smooth)
                    for (const auto& n : m.surface->normals)
                        all.normals.emplace_back(normal_of(m, n), 0.0f);
                all.normals.resize(all.triangles.positions.size(), glm::vec4(0));
            }
            if (any_colored_)
                for (std::size_t v = 0; v < m.surface->positions.size(); ++v) {
                    const auto& places = m.surface->texture_coordinates;
                    out_.attributes.emplace_back(places.empty() ? glm::vec2(0) : places[v], 0.0f, 0.0f);
                    out_.attributes.emplace_back(m.surface->colors.empty() ? glm::vec3(1) : m.surface->colors[v], 0.0f);
                }
            const bool mirrored = is_mirrored(m); // as corners_of(placed_mesh)
            for (auto t : m.surface->triangles) {
                if (mirrored)
                    std::swap(t.y, t.z);
                all.triangles.triangles.push_back(t + vertices);
                all.faces.emplace_back(t + vertices, code);
                write_plane(all.faces.size() - 1);
            }
        }

        /// The shares of a light's area up to each of its triangles, which begin at `first`.
        void write_shares(const placed_mesh& m, std::size_t first)
        {
            const double total = area_of(m);
            double area = 0;
            for (std::size_t t = first; t < out_.faces.size(); ++t) {
                area += area_of(corners_of(m, t - first));
                out_.shares.push_back(static_cast<uint>(std::min(area / total * 0x1p32, 0xFFFFFFFFp0)));
            }
            out_.shares.back() = 0xFFFFFFFFu;
        }

    private:
        /// The plane of a triangle as it is in single precision. A triangle without area has that of any that contains
        /// its longest edge.
        void write_plane(std::size_t triangle)
        {
            const auto corners = corners_of(out_.triangles, triangle);
            const dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
            dvec3 n = glm::cross(b - a, c - a);
            if (!(glm::length(n) > 0)) {
                const dvec3 ab = b - a, ac = c - a, edge = glm::dot(ab, ab) > glm::dot(ac, ac) ? ab : ac;
                const dvec3 other = std::abs(edge.x) < std::abs(edge.y) ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
                n = glm::cross(edge, other);
                if (!(glm::length(n) > 0))
                    n = dvec3(0, 0, 1);
            }
            n = glm::normalize(n);
            out_.planes.emplace_back(glm::vec3(n), static_cast<float>(glm::dot(n, a)));
        }

        mesh_layout& out_;
        dvec3 center_;
        bool any_smooth_, any_colored_;
    };
} // namespace detail

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
