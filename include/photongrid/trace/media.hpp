// What light travels in: the insides of bodies of glass that touch, overlap, stand in each other, or absorb light.
// Where they overlap, the one of the highest priority is there (Schmidt and Budge, Simple Nested Dielectrics in Ray
// Traced Images, Journal of Graphics Tools 7(2), 2002), so that a liquid may be drawn a little into its glass.
#pragma once

#include <photongrid/scene/scene.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The inside of bodies of a material.
struct medium {
    std::uint32_t material = 0;       ///< index into scene::materials
    double index_of_refraction = 1.5; ///< of an interface, relative to what is outside of it
    dvec3 absorption{0};              ///< rgb, 1/m
    bool is_interface = false;        ///< it is there wherever its surface says, whatever its priority

    bool operator==(const medium&) const = default;
};

/// The most media of a scene: a ray has a bit for each.
constexpr std::size_t most_media = 22;

namespace detail {
    /// The bodies of a material that refracts: their boxes, and the volume of all.
    struct glass_body {
        std::uint32_t material = 0;
        std::vector<bounds> boxes{};
        double volume = 0; ///< m^3
    };

    /// The volume that a closed mesh encloses, m^3, whichever way it is wound.
    inline double volume_of(const placed_mesh& m)
    {
        double volume = 0;
        const dvec3 middle = corners_of(m, 0)[0];
        for (std::size_t t = 0; t < m.surface->triangles.size(); ++t) {
            const auto c = corners_of(m, t);
            volume += glm::dot(c[0] - middle, glm::cross(c[1] - middle, c[2] - middle)) / 6;
        }
        return std::abs(volume);
    }

    /// The bodies of each material that refracts, in the order of materials.
    inline std::vector<glass_body> glass_bodies(const scene& s)
    {
        std::map<std::uint32_t, glass_body> found;
        const auto add = [&](const auto& x, auto kind) {
            const auto& m = s.materials[x.material];
            const auto parts = parts_of(s.materials, m);
            for (const auto* part : parts)
                if (refracts(*part)) {
                    const auto number = static_cast<std::uint32_t>(part - s.materials.data());
                    auto& body = found[number];
                    body.material = number;
                    kind.add_bounds(body.boxes.emplace_back(), x);
                    const dvec3 size = body.boxes.back().high - body.boxes.back().low;
                    if constexpr (requires { volume_of(x); })
                        body.volume += volume_of(x);
                    else
                        body.volume += size.x * size.y * size.z;
                }
        };
        for_each_shape(s, [&](const auto& list, auto kind) {
            for (const auto& x : list)
                add(x, kind);
        });
        for (const auto& m : s.meshes)
            add(m, shape_kind<placed_mesh>{});
        std::vector<glass_body> all;
        for (auto& [number, body] : found)
            all.push_back(std::move(body));
        return all;
    }

    /// Whether two boxes are at most `within` apart, m.
    inline bool boxes_touch(const bounds& a, const bounds& b, double within)
    {
        return glm::all(glm::lessThanEqual(a.low - within, b.high))
            && glm::all(glm::lessThanEqual(b.low - within, a.high));
    }

    /// Whether a box of one touches one of the other. Sorted along x, boxes are compared with those they may meet.
    inline bool bodies_touch(glass_body& a, glass_body& b, double within)
    {
        const auto by_x = [](const bounds& x, const bounds& y) { return x.low.x < y.low.x; };
        std::sort(a.boxes.begin(), a.boxes.end(), by_x);
        std::sort(b.boxes.begin(), b.boxes.end(), by_x);
        for (const auto& x : a.boxes)
            for (const auto& y : b.boxes) {
                if (y.low.x - within > x.high.x)
                    break;
                if (boxes_touch(x, y, within))
                    return true;
            }
        return false;
    }
} // namespace detail

/// The media of a scene, the one of the lowest priority first: of those of the same priority that of the largest
/// volume, so that ice wins over water. There are none unless bodies of different glass touch, by their boxes, or
/// absorb.
/// \throws std::invalid_argument for more than most_media.
inline std::vector<medium> media_of(const scene& s)
{
    auto bodies = detail::glass_bodies(s);
    if (bodies.empty())
        return {};
    const bounds all = bounds_of(s);
    const double within = 1e-4 * glm::length(all.high - all.low);
    const auto is_interface = [&](const detail::glass_body& b) { return s.materials[b.material].priority == 0; };
    std::vector<bool> counts(bodies.size());
    for (std::size_t a = 0; a < bodies.size(); ++a) {
        counts[a] = counts[a] || s.materials[bodies[a].material].absorption != dvec3(0);
        for (std::size_t b = a + 1; b < bodies.size() && !is_interface(bodies[a]); ++b)
            if (!is_interface(bodies[b]) && !(counts[a] && counts[b])
                && detail::bodies_touch(bodies[a], bodies[b], within))
                counts[a] = counts[b] = true;
    }
    std::vector<detail::glass_body> chosen;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (counts[i])
            chosen.push_back(std::move(bodies[i]));
    detail::require(chosen.size() <= most_media,
        "materials: more than 22 kinds of glass touch others or absorb light; give bodies that are alike one material");
    std::stable_sort(chosen.begin(), chosen.end(), [&](const auto& a, const auto& b) {
        const double pa = s.materials[a.material].priority, pb = s.materials[b.material].priority;
        return pa < pb || (pa == pb && a.volume > b.volume);
    });
    std::vector<medium> media;
    for (const auto& b : chosen) {
        const auto& m = s.materials[b.material];
        media.push_back({b.material, m.index_of_refraction, m.absorption, is_interface(b)});
    }
    return media;
}

namespace detail {
    /// Calls visit(medium's number) for each part of a material that is one.
    template <class Visit>
    void for_each_medium_of(const scene& s, const std::vector<medium>& media, std::uint32_t material, Visit visit)
    {
        for (const auto* part : parts_of(s.materials, s.materials[material]))
            for (std::size_t n = 0; n < media.size(); ++n)
                if (part == &s.materials[media[n].material])
                    visit(n);
    }

    /// A surface whose vertices are moved outwards along the mean of the normals around them, by `far`, in its own
    /// units.
    inline std::shared_ptr<const mesh> grown(const mesh& m, double far)
    {
        // Vertices at one place must stay together.
        std::map<std::array<float, 3>, dvec3> normals;
        const auto place = [&](std::size_t v) {
            const auto& p = m.positions[v];
            return std::array{p.x, p.y, p.z};
        };
        for (std::size_t t = 0; t < m.triangles.size(); ++t) {
            const auto c = corners_of(m, t);
            const dvec3 area = glm::cross(dvec3(c[1]) - dvec3(c[0]), dvec3(c[2]) - dvec3(c[0]));
            for (int i = 0; i < 3; ++i)
                normals[place(m.triangles[t][i])] += area;
        }
        auto made = m;
        for (std::size_t v = 0; v < m.positions.size(); ++v)
            if (const dvec3 n = normals[place(v)]; glm::length(n) > 0)
                made.positions[v] = glm::vec3(dvec3(m.positions[v]) + far * glm::normalize(n));
        return std::make_shared<const mesh>(std::move(made));
    }
} // namespace detail

/// Lets the bodies of a medium reach a little into those of media above, so that walls which two bodies share are in
/// the one of the higher priority: rays start a little off the surface that they leave, and would miss the other wall.
/// Cylinders, cones and paraboloids stay as they are.
inline void part_walls(scene& s, const std::vector<medium>& media)
{
    if (media.empty())
        return;
    const bounds all = bounds_of(s);
    const dvec3 middle = 0.5 * (all.low + all.high);
    double farthest = 0; // m; rays' offsets are a part of that
    for (const auto& b : detail::glass_bodies(s))
        for (const auto& box : b.boxes)
            farthest = std::max({farthest, glm::length(box.high - middle), glm::length(box.low - middle)});
    const double step = 0x1p-14 * farthest;
    const auto growth = [&](std::uint32_t material) {
        double more = 0;
        detail::for_each_medium_of(s, media, material, [&](std::size_t n) {
            if (!media[n].is_interface)
                more = step * static_cast<double>(media.size() - 1 - n);
        });
        return more;
    };
    for (auto& x : s.spheres)
        x.radius += growth(x.material);
    for (auto& x : s.boxes)
        if (const double far = growth(x.material); far > 0)
            for (auto* edge : {&x.edge_u, &x.edge_v, &x.edge_w}) {
                const dvec3 along = far * glm::normalize(*edge);
                x.corner -= along;
                *edge += 2.0 * along;
            }
    std::map<std::pair<std::shared_ptr<const mesh>, double>, std::shared_ptr<const mesh>> made;
    for (auto& m : s.meshes)
        if (const double far = growth(m.material); far > 0) {
            const double scaled = far / std::cbrt(std::abs(glm::determinant(m.linear)));
            auto& surface = made[{m.surface, scaled}];
            if (!surface)
                surface = detail::grown(*m.surface, scaled);
            m.surface = surface;
        }
}

/// Where the media of a scene are: of spheres, boxes and meshes.
class media_places {
public:
    media_places() = default;
    media_places(const scene& s, std::vector<medium> media) : media_(std::move(media))
    {
        const auto add = [&](auto& bodies, const auto& list) {
            for (const auto& x : list)
                detail::for_each_medium_of(s, media_, x.material, [&](std::size_t n) { bodies.push_back({n, x}); });
        };
        add(spheres_, s.spheres);
        add(boxes_, s.boxes);
        add(meshes_, s.meshes);
    }

    const std::vector<medium>& media() const { return media_; }

    /// The media at p, m: bit n for medium n.
    std::uint32_t at(const dvec3& p) const
    {
        if (media_.empty())
            return 0;
        std::vector<double> turns(media_.size(), 0); // how often surfaces wind around p
        for (const auto& [n, x] : spheres_)
            turns[n] += glm::length(p - x.center) < x.radius ? 1 : 0;
        for (const auto& [n, x] : boxes_) {
            bool inside = true;
            for (const auto& edge : {x.edge_u, x.edge_v, x.edge_w}) {
                const double along = glm::dot(p - x.corner, edge) / glm::dot(edge, edge);
                inside = inside && along > 0 && along < 1;
            }
            turns[n] += inside ? 1 : 0;
        }
        for (const auto& [n, x] : meshes_)
            for (std::size_t t = 0; t < x.surface->triangles.size(); ++t)
                turns[n] += solid_angle(p, corners_of(x, t)) / (4 * std::numbers::pi);
        std::uint32_t found = 0;
        for (std::size_t n = 0; n < turns.size(); ++n)
            found |= turns[n] > 0.5 ? 1u << n : 0u;
        return found;
    }

private:
    /// Of a triangle, seen from p; positive from behind (van Oosterom and Strackee 1983).
    static double solid_angle(const dvec3& p, const std::array<dvec3, 3>& corners)
    {
        const dvec3 a = corners[0] - p, b = corners[1] - p, c = corners[2] - p;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        return 2
            * std::atan2(glm::dot(a, glm::cross(b, c)),
                la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }

    template <class Shape>
    struct body {
        std::size_t medium;
        Shape shape;
    };
    std::vector<medium> media_;
    std::vector<body<sphere>> spheres_;
    std::vector<body<box>> boxes_;
    std::vector<body<placed_mesh>> meshes_;
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
