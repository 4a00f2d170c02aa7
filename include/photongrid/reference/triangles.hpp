// The triangles of meshes for the reference renderer: in double precision, in a tree of boxes of its own, which is
// split at the median.
#pragma once

#include <photongrid/reference/ray.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// Triangles and the tree of their boxes.
class triangle_set {
public:
    /// The triangles of all mesh lights and of all meshes of a scene, in their order.
    explicit triangle_set(const scene& s)
    {
        for (const auto& l : s.mesh_lights)
            add(l.surface, nothing, false);
        for (const auto& m : s.meshes)
            add(m, m.material, true, has_texture(s.materials, s.materials[m.material]));
        order_.resize(triangles_.size());
        std::iota(order_.begin(), order_.end(), 0u);
        if (!order_.empty())
            build(0, static_cast<std::uint32_t>(order_.size()));
    }

    /// How many there are.
    std::uint32_t size() const { return static_cast<std::uint32_t>(triangles_.size()); }
    /// The material of a triangle; `nothing` for a light's.
    std::uint32_t material(std::uint32_t triangle) const { return materials_[triangle]; }
    /// A point of a triangle, evenly for u and v from 0 to 1.
    dvec3 point(std::uint32_t triangle, double u, double v) const
    {
        const auto& t = triangles_[triangle];
        const double root = std::sqrt(u);
        return t.corner + root * (1 - v) * t.edge_u + root * v * t.edge_v;
    }
    /// The normal of a triangle, unit.
    const dvec3& normal(std::uint32_t triangle) const { return triangles_[triangle].normal; }
    /// The area of a triangle, m^2.
    double area(std::uint32_t triangle) const
    {
        return 0.5 * glm::length(glm::cross(triangles_[triangle].edge_u, triangles_[triangle].edge_v));
    }

    /// Calls visit(triangle, t) for triangles that the ray hits at t < far, other than `from`, until it returns the
    /// distance up to which the rest matters; `far` is updated with it.
    template <class Visit>
    void each_hit(const ray& r, std::uint32_t from, double far, Visit visit) const
    {
        if (nodes_.empty())
            return;
        const dvec3 inverse = 1.0 / r.direction;
        std::vector<std::uint32_t> open{0};
        while (!open.empty() && far > 0) {
            const node& n = nodes_[open.back()];
            open.pop_back();
            if (!meets(n, r, inverse, far))
                continue;
            if (n.right != 0) {
                open.push_back(n.right);
                open.push_back(static_cast<std::uint32_t>(&n - nodes_.data()) + 1);
                continue;
            }
            for (std::uint32_t i = n.first; i < n.past; ++i)
                if (order_[i] != from)
                    if (const double t = distance(triangles_[order_[i]], r); t < far)
                        far = visit(order_[i], t);
        }
    }

    /// Moves p onto a triangle's plane and returns its normal.
    dvec3 settle(std::uint32_t triangle, dvec3& p) const
    {
        const auto& t = triangles_[triangle];
        p -= glm::dot(p - t.corner, t.normal) * t.normal;
        return t.normal;
    }

    /// The interpolated normal at a point of a triangle, unit, on the side of `normal`; without normals that.
    dvec3 shading(std::uint32_t triangle, const dvec3& p, const dvec3& normal) const
    {
        const auto& t = triangles_[triangle];
        if (t.smooth < 0)
            return normal;
        const auto& of = normals_[static_cast<std::size_t>(t.smooth)];
        const dvec3 weights = weights_at(t, p), sum = weights[0] * of[0] + weights[1] * of[1] + weights[2] * of[2];
        const double length = glm::length(sum);
        if (!(length > 0) || !std::isfinite(length))
            return normal;
        return glm::dot(sum, normal) < 0 ? -sum / length : sum / length;
    }

    /// What the vertices of a triangle say at a point of it.
    struct attributes {
        dvec3 color{1};
        glm::dvec2 coordinates{0};
    };
    attributes attributes_at(std::uint32_t triangle, const dvec3& p) const
    {
        const auto& t = triangles_[triangle];
        if (t.colored < 0)
            return {};
        const auto& of = colored_[static_cast<std::size_t>(t.colored)];
        const dvec3 w = weights_at(t, p);
        const auto mixed
            = [&](const auto& corners) { return w[0] * corners[0] + w[1] * corners[1] + w[2] * corners[2]; };
        return {mixed(of.colors), mixed(of.coordinates)};
    }

private:
    void add(const placed_mesh& m, std::uint32_t material, bool with_normals, bool textured = false)
    {
        const auto& coordinates = m.surface->texture_coordinates;
        const auto& colors = m.surface->colors;
        const bool colored = material != nothing && (textured || !colors.empty());
        for (std::size_t t = 0; t < m.surface->triangles.size(); ++t) {
            const auto c = corners_of(m, t);
            const dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
            const double area = glm::length(n);
            triangles_.push_back({c[0], c[1] - c[0], c[2] - c[0], area > 0 ? n / area : dvec3(0, 0, 1)});
            materials_.push_back(material);
            if (const auto& normals = m.surface->normals; with_normals && !normals.empty()) {
                const auto& v = m.surface->triangles[t];
                std::array<dvec3, 3> of{
                    normal_of(m, normals[v.x]), normal_of(m, normals[v.y]), normal_of(m, normals[v.z])};
                if (glm::determinant(m.linear) < 0)
                    std::swap(of[1], of[2]); // as corners_of does
                triangles_.back().smooth = static_cast<std::int64_t>(normals_.size());
                normals_.push_back(of);
            }
            if (colored) {
                triangles_.back().colored = static_cast<std::int64_t>(colored_.size());
                auto& of = colored_.emplace_back();
                for (int i = 0; i < 3; ++i) {
                    const int corner = i > 0 && glm::determinant(m.linear) < 0 ? 3 - i : i; // as corners_of does
                    const auto v = m.surface->triangles[t][corner];
                    const auto at = static_cast<std::size_t>(i);
                    of.coordinates[at] = coordinates.empty() ? glm::dvec2(0) : glm::dvec2(coordinates[v]);
                    of.colors[at] = colors.empty() ? dvec3(1) : dvec3(colors[v]);
                }
            }
        }
    }

    struct face {
        dvec3 corner, edge_u, edge_v, normal;
        std::int64_t smooth = -1;  ///< index in normals_
        std::int64_t colored = -1; ///< index in colored_
    };
    /// Of a triangle's corners.
    struct corner_colors {
        std::array<glm::dvec2, 3> coordinates{};
        std::array<dvec3, 3> colors{};
    };

    /// The weights of a triangle's corners at a point, whose sum is 1.
    static dvec3 weights_at(const face& t, const dvec3& p)
    {
        const dvec3 from = p - t.corner, area = glm::cross(t.edge_u, t.edge_v);
        const double area2 = glm::dot(area, area), v = glm::dot(glm::cross(from, t.edge_v), area) / area2,
                     w = glm::dot(glm::cross(t.edge_u, from), area) / area2;
        return {1 - v - w, v, w};
    }

    struct node {
        dvec3 low{infinity}, high{-infinity};
        std::uint32_t right = 0;           ///< its second child; the first one follows it; 0: a leaf
        std::uint32_t first = 0, past = 0; ///< of a leaf, in order_
    };

    /// By Cramer's rule (Möller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997), a little larger
    /// than the triangle, so that rounding opens no gap between neighbours.
    static double distance(const face& t, const ray& r)
    {
        constexpr double margin = 1e-12;
        const dvec3 p = glm::cross(r.direction, t.edge_v), from = r.origin - t.corner, q = glm::cross(from, t.edge_u);
        const double inverse = 1 / glm::dot(t.edge_u, p), u = glm::dot(from, p) * inverse,
                     v = glm::dot(r.direction, q) * inverse, at = glm::dot(t.edge_v, q) * inverse;
        return u >= -margin && v >= -margin && u + v <= 1 + margin && at > 0 ? at : infinity;
    }

    static bool meets(const node& n, const ray& r, const dvec3& inverse, double far)
    {
        double enter = 0, leave = far;
        for (int i = 0; i < 3; ++i) {
            const double a = (n.low[i] - r.origin[i]) * inverse[i], b = (n.high[i] - r.origin[i]) * inverse[i];
            if (std::isnan(a) || std::isnan(b)) // along the plane of a face
                continue;
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter <= leave * (1 + 1e-12);
    }

    dvec3 corner(std::uint32_t i, int which) const
    {
        const auto& t = triangles_[order_[i]];
        return which == 0 ? t.corner : t.corner + (which == 1 ? t.edge_u : t.edge_v);
    }

    void build(std::uint32_t first, std::uint32_t past)
    {
        const std::size_t at = nodes_.size();
        node made;
        for (std::uint32_t i = first; i < past; ++i)
            for (int c = 0; c < 3; ++c) {
                made.low = glm::min(made.low, corner(i, c));
                made.high = glm::max(made.high, corner(i, c));
            }
        const double margin = 1e-12 * glm::length(made.high - made.low);
        made.low -= margin;
        made.high += margin;
        made.first = first;
        made.past = past;
        nodes_.push_back(made);
        if (past - first <= 4)
            return;
        const dvec3 size = made.high - made.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto middle_of = [&](std::uint32_t t) {
            return (3.0 * triangles_[t].corner + triangles_[t].edge_u + triangles_[t].edge_v)[axis];
        };
        const std::uint32_t half = first + (past - first) / 2;
        std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + past,
            [&](std::uint32_t a, std::uint32_t b) { return middle_of(a) < middle_of(b); });
        build(first, half);
        nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
        build(half, past);
    }

    std::vector<face> triangles_;
    std::vector<std::array<dvec3, 3>> normals_; ///< of the corners of triangles that have any
    std::vector<corner_colors> colored_;
    std::vector<std::uint32_t> materials_;
    std::vector<std::uint32_t> order_; ///< of the triangles in the leaves
    std::vector<node> nodes_;          ///< the root first
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
