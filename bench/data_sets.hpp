// Photons and query points that neighbour searches are measured with: S1 to S5 of docs/reference/measures.md. Lengths
// in metres.
#pragma once

#include <photongrid/map/map_buffers.hpp>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace photongrid::bench {

using glm::vec3;
using glm::vec4;

struct data_set {
    std::string name, what;
    uint k = 0;
    std::vector<vec4> positions, powers;
    std::vector<vec4> points; ///< w: 1, as searches want it
};

class random_source {
public:
    explicit random_source(uint seed) : engine_(seed) {}
    float operator()() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }
    /// Standard normal (Box and Muller 1958).
    float normal() { return std::sqrt(-2 * std::log(1 - (*this)())) * std::cos(6.2831853f * (*this)()); }

private:
    std::mt19937 engine_;
};

/// A parallelogram.
struct face {
    vec3 corner, u, v;
};

/// Five faces of the unit box, open towards z = 0, and the upper five of two boxes in it.
inline std::vector<face> room_with_two_boxes()
{
    const vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    std::vector<face> faces{{vec3(0), x, z}, {y, x, z}, {vec3(0), y, z}, {x, y, z}, {z, x, y}};
    for (const auto& low : {vec3(0.15f, 0, 0.2f), vec3(0.55f, 0, 0.5f)}) {
        const vec3 a = 0.3f * x, b = 0.3f * y, c = 0.3f * z;
        for (const auto& f :
            {face{low + b, a, c}, face{low, a, b}, face{low + c, a, b}, face{low, b, c}, face{low + a, b, c}})
            faces.push_back(f);
    }
    return faces;
}

inline void add_powers(data_set& s, random_source& u)
{
    for (std::size_t i = 0; i < s.positions.size(); ++i)
        s.powers.emplace_back(u(), u(), u(), 0.0f);
}

/// Photons spread evenly over the faces; points where the eye rays of a 512 x 512 pinhole camera before the open face
/// meet them.
inline data_set box_faces(std::string name, uint photons, uint k)
{
    data_set s{std::move(name), std::to_string(photons) + " on the faces of a room with two boxes", k, {}, {}, {}};
    const auto faces = room_with_two_boxes();
    random_source u(1);
    const auto area_of = [](const face& f) { return static_cast<double>(glm::length(glm::cross(f.u, f.v))); };
    double area = 0;
    for (const auto& f : faces)
        area += area_of(f);
    for (uint i = 0; i < photons; ++i) {
        double left = static_cast<double>(u()) * area;
        std::size_t which = 0;
        for (; which + 1 < faces.size() && left > area_of(faces[which]); ++which)
            left -= area_of(faces[which]);
        const float a = u(), b = u();
        s.positions.emplace_back(faces[which].corner + a * faces[which].u + b * faces[which].v, 0.0f);
    }
    add_powers(s, u);
    const vec3 eye(0.5f, 0.5f, -1.2f);
    for (int row = 0; row < 512; ++row)
        for (int column = 0; column < 512; ++column) {
            const vec3 ray(
                (static_cast<float>(column) + 0.5f) / 512 - 0.5f, (static_cast<float>(row) + 0.5f) / 512 - 0.5f, 1.2f);
            float nearest = std::numeric_limits<float>::infinity();
            for (const auto& f : faces) {
                const vec3 n = glm::cross(f.u, f.v);
                const float t = glm::dot(f.corner - eye, n) / glm::dot(ray, n);
                const vec3 hit = eye + t * ray - f.corner;
                const float a = glm::dot(hit, f.u) / glm::dot(f.u, f.u), b = glm::dot(hit, f.v) / glm::dot(f.v, f.v);
                if (t > 0 && t < nearest && a >= 0 && a <= 1 && b >= 0 && b <= 1)
                    nearest = t;
            }
            if (std::isfinite(nearest))
                s.points.emplace_back(eye + nearest * ray, 1.0f);
        }
    return s;
}

/// Where the rays of a 512 x 384 camera meet a table: rows get shorter and closer together with distance.
inline void look_at_table(data_set& s)
{
    for (int row = 0; row < 384; ++row)
        for (int column = 0; column < 512; ++column) {
            const float shrink = 1 / (1 + 1.5f * (static_cast<float>(row) + 0.5f) / 384);
            const float x = 0.5f + ((static_cast<float>(column) + 0.5f) / 512 - 0.5f) * (0.5f + 0.5f * shrink);
            s.points.emplace_back(x, 0.0f, (1 - shrink) / (1 - 1 / 2.5f), 1.0f);
        }
}

/// Half of the photons in a disc of a hundredth of the unit square, with density 1/r; the others anywhere in the
/// square.
inline data_set caustic_spot(std::string name, uint photons, uint k)
{
    data_set s{std::move(name), std::to_string(photons) + ", half of them in a spot on a plane", k, {}, {}, {}};
    random_source u(1);
    const float radius = std::sqrt(0.01f / 3.1415927f);
    for (uint i = 0; i < photons; ++i) {
        float x = u(), z = u();
        if (i % 2 == 0) {
            const float r = radius * x, angle = 6.2831853f * z;
            x = 0.5f + r * std::cos(angle);
            z = 0.5f + r * std::sin(angle);
        }
        s.positions.emplace_back(x, 0.0f, z, 0.0f);
    }
    add_powers(s, u);
    look_at_table(s);
    return s;
}

/// 60 % of the photons along a cardioid, the others anywhere in the unit square.
inline data_set cardioid(std::string name, uint photons, uint k)
{
    data_set s{std::move(name), std::to_string(photons) + ", most of them along a cardioid on a plane", k, {}, {}, {}};
    random_source u(1);
    for (uint i = 0; i < photons; ++i) {
        float x = u(), z = u();
        if (i % 5 < 3) {
            const float angle = 6.2831853f * x, r = 0.17f * (1 - std::cos(angle));
            x = 0.6f + r * std::cos(angle) + 0.008f * u.normal();
            z = 0.5f + r * std::sin(angle) + 0.008f * u.normal();
        }
        s.positions.emplace_back(x, 0.0f, z, 0.0f);
    }
    add_powers(s, u);
    look_at_table(s);
    return s;
}

inline data_set make_data_set(int number)
{
    switch (number) {
    case 1: return caustic_spot("S1", 5000, 32);
    case 2: return cardioid("S2", 16000, 64);
    case 3: return box_faces("S3", 65000, 500);
    case 4: return box_faces("S4", 1000000, 50);
    default: return box_faces("S5", 1000000, 500);
    }
}

} // namespace photongrid::bench
