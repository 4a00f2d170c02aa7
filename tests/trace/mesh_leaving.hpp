// Flat meshes, and rays that leave them: none hits them again.
#pragma once

#include "probe_rays.hpp"

#include <photongrid/trace/mesh_search.hpp>

#include <cmath>
#include <memory>
#include <vector>

namespace photongrid::testing {

/// A flat mesh of `seed % 5`: a quadrilateral, a triangle, a fan about its middle, a grid, a grid in two places that is
/// stored once. It stands in any plane, near the middle of the scene or not, and every fourth is ten times as long as
/// it is wide. Returns its size, m.
inline double flat_mesh(std::uint64_t seed, scene& s)
{
    random_source u(seed);
    const auto number = [&] { return static_cast<double>(u()); };
    const auto direction = [&] { return dvec3(random_direction(u)); };
    const auto turn = [&] {
        const dvec3 x = direction(), y = glm::normalize(glm::cross(x, direction()));
        return glm::dmat3(x, y, glm::cross(x, y));
    };
    const double size = std::pow(10.0, 6 * number() - 3);
    const auto axes = seed % 3 == 0 ? glm::dmat3(1) : turn();
    const dvec3 middle = seed % 2 == 0 ? dvec3(0) : 3 * size * number() * direction();
    mesh m;
    const auto put = [&](double x, double y) {
        const double width = seed % 4 == 3 ? 0.1 : 1;
        m.positions.emplace_back(middle + size * ((x - 0.5) * axes[0] + (y - 0.5) * width * axes[1]));
    };
    const auto grid = [&](uint cells) {
        const auto n = static_cast<double>(cells);
        for (uint i = 0; i <= cells; ++i)
            for (uint j = 0; j <= cells; ++j) {
                put(static_cast<double>(i) / n, static_cast<double>(j) / n);
                const uint k = cells + 1, p = i * k + j;
                if (i < cells && j < cells)
                    m.triangles.insert(m.triangles.end(), {{p, p + 1, p + k + 1}, {p, p + k + 1, p + k}});
            }
    };
    switch (seed % 5) {
    case 0: grid(1); break;
    case 1:
        put(0, number());
        put(1, number());
        put(number(), 1.5 + number());
        m.triangles = {{0, 1, 2}};
        break;
    case 2: {
        put(0.5, 0.5);
        const auto sides = static_cast<uint>(3 + seed % 7);
        for (uint i = 0; i < sides; ++i) {
            const double angle = 2 * M_PI * i / sides;
            put(0.5 + 0.5 * std::cos(angle), 0.5 + 0.5 * std::sin(angle));
            m.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % sides);
        }
        break;
    }
    case 3: grid(6); break;
    default: grid(24);
    }
    s = empty_scene(0.1 * size * direction());
    s.meshes = {{"", std::make_shared<const mesh>(m), glm::dmat3(1), dvec3(0), 0}};
    if (seed % 5 == 4) {
        glm::dmat3 scale(1);
        scale[0][0] = std::pow(10.0, number());
        scale[1][1] = 1 / scale[0][0];
        scale[2][2] = seed % 2 == 0 ? 1 : -0.5;
        s.meshes[0].linear = turn() * scale * turn();
        s.meshes[0].offset = 3 * size * number() * direction();
        s.meshes.push_back(s.meshes[0]);
        s.meshes[1].offset = 500 * size * direction();
    }
    return size;
}

/// The hits of rays on the meshes of a scene.
struct mesh_surfaces {
    std::vector<glm::vec4> places, normals, shadings; ///< see trace/mesh_surface.glsl
};
template <backend B>
mesh_surfaces surfaces_hit(B& b, const device_scene<B>& s, const rays& r)
{
    auto origins = r.origins;
    for (auto& o : origins)
        o.w = 3e38f;
    detail::mesh_rays<B> rays(b, r.size());
    rays.origins = b.upload(std::span<const glm::vec4>(origins));
    rays.directions = b.upload(std::span<const glm::vec4>(r.directions));
    detail::mesh_hits<B> hits(b, s, r.size());
    rays.find(b, s, hits);
    return {b.download(hits.places), b.download(hits.normals), b.download(hits.shadings)};
}

/// Rays that leave the first mesh of a scene, which is flat, from where `n` others hit it: a third close to edges, a
/// ninth close to corners, and a ninth close to the middle of the scene.
template <backend B>
rays leaving_rays(B& b, const scene& s, const device_scene<B>& device, std::uint64_t seed, std::size_t n, double size)
{
    random_source u(seed);
    const auto number = [&] { return static_cast<double>(u()); };
    const auto& m = s.meshes[0];
    rays to;
    for (std::size_t i = 0; i < n; ++i) {
        const auto triangles = static_cast<double>(m.surface->triangles.size());
        const auto c = corners_of(m, static_cast<std::size_t>(number() * triangles * 0.999999));
        dvec3 w(-std::log(number() + 1e-9), -std::log(number() + 1e-9), -std::log(number() + 1e-9));
        const auto corner = static_cast<int>(number() * 2.999);
        if (i % 3 == 1 || i % 9 == 2)
            w[corner] *= std::pow(10.0, -9 * number());
        if (i % 9 == 2)
            w[(corner + 1) % 3] *= std::pow(10.0, -9 * number());
        dvec3 p = (c[0] * w.x + c[1] * w.y + c[2] * w.z) / (w.x + w.y + w.z) - device.layout.center;
        if (i % 9 == 5) {
            const dvec3 normal = glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0])),
                        foot = normal * glm::dot(normal, p);
            p = foot + (p - foot) * std::pow(10.0, -7 * number());
        }
        to.aim(glm::vec3(p + size * std::pow(10.0, -3 * number()) * dvec3(random_direction(u))), p);
    }
    const auto hits = surfaces_hit(b, device, to);
    rays away;
    for (std::size_t i = 0; i < n; ++i) {
        if (hits.places[i].w < 0)
            continue;
        const glm::vec3 p(hits.places[i]), normal(hits.normals[i]);
        const dvec3 along = glm::normalize(glm::cross(dvec3(normal), dvec3(random_direction(u))));
        // Distributed as the cosine, every fourth ray closer to the surface.
        const double height = std::sqrt(number()) * (i % 4 == 0 ? std::pow(10.0, -3 * number()) : 1);
        const dvec3 d = along * std::sqrt(1 - height * height) + dvec3(normal) * (u() < 0.5f ? height : -height);
        const float share = device.layout.records[kernels::SCENE_SIZES].x + hits.shadings[i].w,
                    off = kernels::ray_offset(p, share);
        away.add(kernels::ray_at(p, normal, glm::dot(d, dvec3(normal)) >= 0 ? off : -off), glm::vec3(d));
    }
    return away;
}

} // namespace photongrid::testing
