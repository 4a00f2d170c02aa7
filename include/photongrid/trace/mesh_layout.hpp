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
        /// colours or texture coordinates. `longest`, m: edges that are longer, and more than four times as long as
        /// they are far from the centre, are split, because rays at a triangle are rounded by its size.
        mesh_writer(mesh_layout& out, const dvec3& center, bool any_smooth, bool any_colored, double longest)
            : out_(out), center_(center), any_smooth_(any_smooth), any_colored_(any_colored), longest_(longest)
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
            const dvec3 middle = dvec3(glm::vec3(0.5 * (b.low + b.high))) + m.surface->origin;
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
            // Those of lights have shares of their area, and surfaces in several places have many triangles.
            const bool splits = (code & kernels::FACE_OF_LIGHT) == 0 && &to == &out_.triangles;
            middles_.clear();
            for (auto t : m.surface->triangles) {
                if (mirrored)
                    std::swap(t.y, t.z);
                write_triangle(to, {t, first, vertices, code, splits});
            }
        }

        /// A triangle by the numbers of its corners in its mesh, whose first vertex is `first` of those that it is
        /// written to, and `vertices` of all.
        struct written_triangle {
            glm::uvec3 corners;
            uint first, vertices, code;
            bool splits;
        };
        /// Writes a triangle, or if its longest edge is too long, both halves.
        void write_triangle(mesh& to, const written_triangle& t)
        {
            double most = 0;
            int longest = 0;
            for (int side = 0; t.splits && side < 3; ++side) {
                const double length
                    = length_to_split(to, t.first + t.corners[side], t.first + t.corners[(side + 1) % 3]);
                longest = length > most ? side : longest;
                most = std::max(most, length);
            }
            if (most > 0) {
                const uint a = t.corners[longest], b = t.corners[(longest + 1) % 3], c = t.corners[(longest + 2) % 3],
                           middle = middle_of(to, t, a, b);
                auto half = t;
                half.corners = {a, middle, c};
                write_triangle(to, half);
                half.corners = {middle, b, c};
                write_triangle(to, half);
                return;
            }
            to.triangles.push_back(t.corners + t.first);
            out_.faces.emplace_back(t.corners + t.vertices, t.code);
            write_plane(corners_of(to, to.triangles.size() - 1));
        }
        /// The length of an edge that is too long, m; else 0. It is the same for both triangles at the edge.
        double length_to_split(const mesh& m, uint from, uint to) const
        {
            const dvec3 a(m.positions[from]), edge = dvec3(m.positions[to]) - a;
            const double length = glm::length(edge);
            if (!(length > longest_))
                return 0;
            const double along = std::clamp(-glm::dot(a, edge) / (length * length), 0.0, 1.0);
            return length > 4 * glm::length(a + along * edge) ? length : 0;
        }
        /// The number in its mesh of the vertex in the middle of an edge.
        uint middle_of(mesh& to, const written_triangle& t, uint a, uint b)
        {
            const auto [found, is_new] = middles_.try_emplace(std::minmax(a, b));
            if (!is_new)
                return found->second;
            found->second = static_cast<uint>(to.positions.size()) - t.first;
            ++vertices_;
            const auto mean = [](auto& all, std::size_t i, std::size_t j) {
                const auto sum = all[i] + all[j];
                all.push_back(0.5f * sum);
            };
            to.positions.emplace_back(0.5 * (dvec3(to.positions[t.first + a]) + dvec3(to.positions[t.first + b])));
            if (any_smooth_)
                mean(out_.normals, t.vertices + a, t.vertices + b);
            for (std::size_t n = 0; any_colored_ && n < 2; ++n)
                mean(out_.attributes, 2 * std::size_t{t.vertices + a} + n, 2 * std::size_t{t.vertices + b} + n);
            return found->second;
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
        double longest_;
        uint vertices_ = 0;                             ///< written so far
        std::map<std::pair<uint, uint>, uint> middles_; ///< of edges of the mesh that is being written
    };
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
