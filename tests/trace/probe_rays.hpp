// Rays against scenes, by the kernel of a test (ray_probe.glsl), and what tests of rays share.
#pragma once

#include "../map/photon_sets.hpp"

#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/scene/scene.hpp>
#include <photongrid/trace/device_scene.hpp>
#include <probes_kernels.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace photongrid::testing {

using real = long double;

/// Vectors of the references: long double throughout.
struct vec3l {
    real x = 0, y = 0, z = 0;
    vec3l() = default;
    vec3l(real a, real b, real c) : x(a), y(b), z(c) {}
    template <class V>
    explicit vec3l(const V& v) : x(static_cast<real>(v.x)), y(static_cast<real>(v.y)), z(static_cast<real>(v.z))
    {
    }
    friend vec3l operator+(vec3l a, vec3l b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend vec3l operator-(vec3l a, vec3l b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend vec3l operator*(real s, vec3l a) { return {s * a.x, s * a.y, s * a.z}; }
    friend real dot(vec3l a, vec3l b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend real length(vec3l a) { return std::sqrt(dot(a, a)); }
};

/// The distance between floats near x.
inline double ulp(double x) { return std::ldexp(1.0, std::max(std::ilogb(std::abs(x)), -126) - 23); }

/// A random unit vector, rounded to float.
inline glm::vec3 random_direction(random_source& u)
{
    for (;;) {
        const dvec3 v(2 * u() - 1, 2 * u() - 1, 2 * u() - 1);
        const double l = glm::length(v);
        if (l > 0.01 && l <= 1)
            return glm::vec3(v / l);
    }
}

/// A scene to put shapes into: materials white and glass, a bulb.
inline scene empty_scene(const dvec3& bulb)
{
    scene s;
    s.name = "shapes";
    s.materials = {{"white", material_kind::lambertian, dvec3(0.5)}, {"glass", material_kind::glass, dvec3(1), 1.5}};
    s.point_lights = {{"bulb", bulb, dvec3(1)}};
    return s;
}

/// A sphere of triangles: an icosahedron, each face split into four, `splits` times.
inline std::vector<polygon> icosphere(const dvec3& center, double radius, int splits)
{
    const double g = 0.5 * (1 + std::sqrt(5.0));
    const dvec3 v[12] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
        {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    const int f[20][3] = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2},
        {10, 7, 6}, {7, 1, 8}, {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8}, {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10},
        {8, 6, 7}, {9, 8, 1}};
    std::vector<std::array<dvec3, 3>> faces;
    for (const auto& t : f)
        faces.push_back({glm::normalize(v[t[0]]), glm::normalize(v[t[1]]), glm::normalize(v[t[2]])});
    for (; splits > 0; --splits) {
        std::vector<std::array<dvec3, 3>> finer;
        for (const auto& [a, b, c] : faces) {
            const dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
            finer.push_back({a, ab, ca});
            finer.push_back({ab, b, bc});
            finer.push_back({ca, bc, c});
            finer.push_back({ab, bc, ca});
        }
        faces = std::move(finer);
    }
    std::vector<polygon> polygons;
    for (const auto& [a, b, c] : faces)
        polygons.push_back({{center + radius * a, center + radius * b, center + radius * c}, 0});
    return polygons;
}

/// The first record of a table of shapes.
inline glm::vec4 first_record(const scene_layout& layout, uint table)
{
    return layout.records[layout.table(table).first];
}

/// Rays, recentred as the scene's records are, and the directions in which others leave from where they hit.
struct rays {
    std::vector<glm::vec4> origins, directions, leavings;
    void add(glm::vec3 o, glm::vec3 d, glm::vec3 leaving = {0, 0, 1})
    {
        origins.emplace_back(o, 0.0f);
        directions.emplace_back(d, 0.0f);
        leavings.emplace_back(leaving, 0.0f);
    }
    /// From o towards a point.
    void aim(const glm::vec3& o, const dvec3& target) { add(o, glm::vec3(glm::normalize(target - dvec3(o)))); }
    std::size_t size() const { return origins.size(); }
};

/// Results of ray_probe.glsl.
struct ray_hits {
    std::vector<glm::vec4> places, facings, starts;
    bool hit(std::size_t i) const { return places[i].w >= 0; }
    std::size_t misses() const
    {
        return static_cast<std::size_t>(
            std::count_if(places.begin(), places.end(), [](const auto& p) { return !(p.w >= 0); }));
    }
};

/// Rays against a scene, by ray_probe.glsl.
template <backend B>
ray_hits trace_rays(B& b, const scene& s, const rays& r)
{
    const auto device = upload_scene(b, s);
    auto out = std::array{b.template make<glm::vec4>(r.size()), b.template make<glm::vec4>(r.size()),
        b.template make<glm::vec4>(r.size())};
    const auto o = b.upload(std::span<const glm::vec4>(r.origins)),
               d = b.upload(std::span<const glm::vec4>(r.directions)),
               l = b.upload(std::span<const glm::vec4>(r.leavings));
    b.template run<probes::ray_probe>({static_cast<uint>(r.size()), 0u, device.layout.features}, {},
        reads(device.records, o, d, l), writes(out[0], out[1], out[2]));
    return {b.download(out[0]), b.download(out[1]), b.download(out[2])};
}
extern template ray_hits trace_rays(serial_backend&, const scene&, const rays&); // serial_rays.cpp

} // namespace photongrid::testing
