// Meshes on which rays get lost, and rays that are aimed at their edges and corners.
#pragma once

#include <photongrid/scene/mesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace photongrid::testing {

struct named_mesh {
    std::string name;
    mesh triangles;
    bool is_closed = false; ///< around the point (0, 0, 0)
};

/// A closed surface around the point 0 with bumps: `rings` x 2 `rings` quadrilaterals, each two triangles, and two
/// caps.
inline mesh bumpy_ball(uint rings, float radius, float bump)
{
    mesh m;
    const uint around = 2 * rings;
    m.positions.push_back({0, 0, radius});
    for (uint r = 1; r < rings; ++r)
        for (uint a = 0; a < around; ++a) {
            const float theta = std::numbers::pi_v<float> * static_cast<float>(r) / static_cast<float>(rings),
                        phi = 2 * std::numbers::pi_v<float> * static_cast<float>(a) / static_cast<float>(around),
                        size = radius * (1 + bump * std::sin(5 * theta) * std::sin(3 * phi));
            m.positions.push_back(
                size * glm::vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
        }
    m.positions.push_back({0, 0, -radius});
    const auto vertex = [&](uint r, uint a) {
        return r == 0 ? 0u : r == rings ? static_cast<uint>(m.positions.size() - 1) : 1 + (r - 1) * around + a % around;
    };
    for (uint r = 0; r < rings; ++r)
        for (uint a = 0; a < around; ++a) {
            if (r > 0)
                m.triangles.push_back({vertex(r, a), vertex(r + 1, a), vertex(r, a + 1)});
            if (r + 1 < rings)
                m.triangles.push_back({vertex(r, a + 1), vertex(r + 1, a), vertex(r + 1, a + 1)});
        }
    return m;
}

/// A ball with the normals of a sphere.
inline mesh smooth_ball(uint rings)
{
    auto m = bumpy_ball(rings, 1, 0);
    m.normals = m.positions;
    return m;
}

/// The rings of a bumpy_ball of about so many triangles.
inline uint rings_of(uint triangles)
{
    return std::max(3u, static_cast<uint>(std::sqrt(static_cast<double>(triangles) / 4)));
}

/// Triangles with one corner in common and opposite edges of 10^-4 of their length.
inline mesh sliver_fan(uint slivers)
{
    mesh m{{{0, 0, 1}}, {}};
    for (uint i = 0; i <= slivers; ++i) {
        const float angle = 1e-4f * static_cast<float>(i);
        m.positions.push_back({std::cos(angle), std::sin(angle), 1});
        if (i > 0)
            m.triangles.push_back({0, i, i + 1});
    }
    return m;
}

/// Triangles whose middles are one point, many of them the same.
inline mesh in_one_point(uint triangles)
{
    mesh m;
    for (uint i = 0; i < triangles; ++i) {
        const float x = 0.5f + 0.125f * static_cast<float>(i % 7), y = 0.5f + 0.25f * static_cast<float>(i % 3);
        for (const auto& p : {glm::vec3(-x, -y, 1), glm::vec3(x, -y, 1), glm::vec3(0, 2 * y, 1)})
            m.positions.push_back(p);
        m.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return m;
}

/// The same surface with a vertex in the middle of an edge of each triangle, where rounding puts it, and a triangle
/// between the edge and its halves: as thin as rounding is large, or a line.
inline mesh with_slivers(const mesh& coarse)
{
    mesh m{coarse.positions, {}};
    for (const auto& t : coarse.triangles) {
        const auto middle = static_cast<uint>(m.positions.size());
        m.positions.push_back(0.5f * (m.positions[t.x] + m.positions[t.y]));
        for (const glm::uvec3& part : {glm::uvec3(t.x, middle, t.z), {middle, t.y, t.z}, {t.x, t.y, middle}})
            m.triangles.push_back(part);
    }
    return m;
}

/// Triangles each twice as large and as far from 0 as the one before. The surface area heuristic alone would cut a few
/// of them off at each level of a tree, down to a depth above its limit.
inline mesh doubling_sizes()
{
    mesh m;
    for (uint i = 0; i < 128; ++i) {
        const float size = std::ldexp(1.0f, static_cast<int>(i) - 70);
        for (const auto& p : {glm::vec3(1, 1, 1), glm::vec3(2, 1, 1), glm::vec3(1, 2, 1)})
            m.positions.push_back(size * p);
        m.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return m;
}

/// `b` after `a`.
inline mesh joined(mesh a, const mesh& b)
{
    const auto first = static_cast<uint>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (const auto& t : b.triangles)
        a.triangles.push_back(t + first);
    return a;
}

/// `size`: about as many triangles as the largest of them have.
inline std::vector<named_mesh> ray_meshes(uint size)
{
    const uint rings = rings_of(size);
    const mesh ball = bumpy_ball(rings, 1, 0.2f);
    return {{"a bumpy ball", ball, true}, {"a bumpy ball with slivers", with_slivers(ball), true},
        {"a ball of 1 um in one of 1,000 km", joined(bumpy_ball(rings, 1e-6f, 0.2f), bumpy_ball(rings, 1e6f, 0.2f)),
            true},
        {"a fan of slivers", sliver_fan(size)}, {"triangles in one point", in_one_point(size)},
        {"sizes that double", doubling_sizes()}, {"one triangle", {{{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}}, {{0, 1, 2}}}},
        {"a point and a line", {{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}, {{0, 0, 0}, {0, 1, 2}}}}, {"nothing", {}}};
}

struct ray_set {
    std::vector<glm::vec4> origins, directions;
};

/// Rays from a place inside a ball of radius `from` about 0, a third each in any direction, at points of edges, and at
/// corners; one in eight along an axis, and `grazing` of eight in the plane of a triangle, about.
inline ray_set rays_at(const mesh& m, std::size_t n, float from, std::uint32_t seed, std::size_t grazing = 0)
{
    std::mt19937 bits(seed);
    const auto u = [&] { return static_cast<float>(bits() >> 8) * 0x1p-24f; };
    const auto any = [&] { return glm::vec3(2 * u() - 1, 2 * u() - 1, 2 * u() - 1); };
    ray_set rays;
    for (std::size_t i = 0; i < n; ++i) {
        glm::vec3 o = i % 5 == 0 ? glm::vec3(0) : from / std::sqrt(3.0f) * any();
        glm::vec3 at = o + any();
        if (i % 3 != 0 && !m.triangles.empty()) {
            const auto& t = corners_of(m, bits() % m.triangles.size());
            at = i % 3 == 1 ? t[0] : glm::mix(t[0], t[1], u());
        }
        glm::vec3 d = at - o;
        if (i % 8 == 7) {
            d = glm::vec3(0);
            d[static_cast<int>(i / 8 % 3)] = i % 16 == 7 ? 1.0f : -2.0f;
        }
        if (i % 8 < grazing && !m.triangles.empty()) {
            const auto t = corners_of(m, bits() % m.triangles.size());
            const auto in_plane = [&](float s, float q) { return t[0] + s * (t[1] - t[0]) + q * (t[2] - t[0]); };
            o = in_plane(4 * any().x, 4 * any().y);
            d = in_plane(0.5f * u(), 0.5f * u()) - o;
        }
        const float longest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
        if (longest > 0)
            d *= std::ldexp(1.0f, -std::ilogb(longest)); // directions have a least length
        rays.origins.emplace_back(o, std::numeric_limits<float>::infinity());
        rays.directions.emplace_back(d, 0.0f);
    }
    return rays;
}

} // namespace photongrid::testing
