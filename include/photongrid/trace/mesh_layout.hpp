// The triangles of a scene's meshes for kernels: faces, planes and normals, in single precision and recentred.
#pragma once

#include <photongrid/scene/placed_mesh.hpp>
#include <photongrid/scene/scene.hpp>
#include <photongrid/trace/scene_layout.kernel.hpp>
#include <photongrid/trace/shared_surfaces.hpp>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The triangles of all meshes of a scene, as trace/mesh_surface.glsl describes them: those of lights, those of
/// surfaces that stand where they are stored, and of each surface that stands in several places, each in the meshes'
/// order.
struct mesh_layout {
    mesh triangles;             ///< but for those of surfaces in several places; recentred; without normals
    std::vector<mesh> surfaces; ///< that stand in several places, in their own space; without normals
    /// Of those, of surface n + 1. If there are any, the first is `triangles` in place, unless there are none.
    std::vector<placement> placements;
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

        /// Appends all meshes of a scene; `light`: the number of the first light of a mesh.
        void write_all(const scene& s, const shared_surfaces& shared, uint light)
        {
            for (const auto& l : s.mesh_lights) {
                const std::size_t first = out_.faces.size();
                write(out_.triangles, l.surface, center_, kernels::FACE_OF_LIGHT + light++, false);
                write_shares(l.surface, first);
            }
            for (const auto& m : s.meshes)
                if (!shared.holds(m))
                    write(out_.triangles, m, center_, code_of(m), is_smooth(m));
            if (!shared.empty())
                write_shared(s, shared);
        }

    private:
        static bool is_smooth(const placed_mesh& m) { return !m.surface->normals.empty(); }
        /// W of its faces (trace/mesh_surface.glsl).
        static uint code_of(const placed_mesh& m) { return 2 * m.material + (is_smooth(m) ? 1 : 0); }

        /// Appends the surfaces that stand in several places, and those.
        void write_shared(const scene& s, const shared_surfaces& shared)
        {
            if (!out_.triangles.triangles.empty())
                out_.placements.push_back({.is_in_place = true});
            struct written_surface {
                std::size_t number = 0;
                uint first_face = 0;
                dvec3 middle{0};
            };
            std::map<const mesh*, written_surface> surfaces;
            for (const auto& m : s.meshes) {
                if (!shared.holds(m))
                    continue;
                const auto [found, is_new] = surfaces.try_emplace(m.surface.get());
                auto& of = found->second;
                if (is_new)
                    of = {surfaces.size(), static_cast<uint>(out_.faces.size()), write_surface(m)};
                out_.placements.push_back(
                    {of.number, m.linear, m.linear * of.middle + m.offset - center_, false, of.first_face, code_of(m)});
            }
        }

        /// A surface in its own space; its middle becomes the origin, and is returned.
        dvec3 write_surface(const placed_mesh& m)
        {
            bounds b;
            for (const auto& p : m.surface->positions)
                b.add(dvec3(p));
            const dvec3 middle(glm::vec3(0.5 * (b.low + b.high)));
            write(out_.surfaces.emplace_back(), {"", m.surface, glm::dmat3(1), dvec3(0), 0}, middle, 0,
                !m.surface->normals.empty());
            return middle;
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

        void write(mesh& to, const placed_mesh& m, const dvec3& center, uint code, bool smooth)
        {
            require_countable(out_.faces.size() + m.surface->triangles.size());
            const auto first = static_cast<uint>(to.positions.size()), vertices = vertices_;
            vertices_ += static_cast<uint>(m.surface->positions.size());
            for (const auto& p : m.surface->positions)
                to.positions.emplace_back(place_of(m, p) - center);
            if (any_smooth_) {
                if (smooth)
                    for (const auto& n : m.surface->normals)
                        out_.normals.emplace_back(normal_of(m, n), 0.0f);
                out_.normals.resize(vertices_, glm::vec4(0));
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
                to.triangles.push_back(t + first);
                out_.faces.emplace_back(t + vertices, code);
                write_plane(corners_of(to, to.triangles.size() - 1));
            }
        }

        /// The plane of a triangle as it is in single precision. A triangle without area has that of any that contains
        /// its longest edge.
        void write_plane(const std::array<glm::vec3, 3>& corners)
        {
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
        uint vertices_ = 0; ///< written so far
    };
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
