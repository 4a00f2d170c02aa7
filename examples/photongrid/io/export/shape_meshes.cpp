#include <photongrid/io/export/shape_meshes.hpp>
#include <photongrid/io/import/tessellation.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace photongrid {

namespace {
    constexpr double whole_turn = 2 * std::numbers::pi;
    constexpr unsigned parts_around = 128, parts_along = 32;

    /// A mesh about the z axis, placed, without the triangles that have no area at a pole or a tip.
    mesh placed_about(mesh m, const glm::dmat3& frame, const dvec3& origin)
    {
        for (auto& p : m.positions)
            p = frame * dvec3(p) + origin;
        for (auto& n : m.normals)
            n = frame * dvec3(n);
        m.texture_coordinates.clear();
        std::erase_if(m.triangles, [&](const glm::uvec3& t) {
            const auto &a = m.positions[t.x], &b = m.positions[t.y], &c = m.positions[t.z];
            return a == b || b == c || c == a;
        });
        return m;
    }

    /// The direction away from the axis at u; the last one is the first one, bit for bit.
    dvec3 spoke(double u)
    {
        return u == 1 ? dvec3(1, 0, 0) : dvec3(std::cos(whole_turn * u), std::sin(whole_turn * u), 0);
    }
} // namespace

glm::dmat3 frame_about(const dvec3& axis)
{
    const dvec3 z = glm::normalize(axis), size = glm::abs(z);
    const dvec3 other = size.x <= size.y && size.x <= size.z ? dvec3(1, 0, 0)
        : size.y <= size.z                                   ? dvec3(0, 1, 0)
                                                             : dvec3(0, 0, 1);
    const dvec3 x = glm::normalize(glm::cross(other, z));
    return {x, glm::cross(z, x), z};
}

mesh mesh_of(const polygon& p)
{
    mesh m;
    for (const auto& v : p.vertices)
        m.positions.emplace_back(v);
    for (std::uint32_t i = 2; i < p.vertices.size(); ++i)
        m.triangles.emplace_back(0, i - 1, i);
    return m;
}

mesh mesh_of(const box& b)
{
    mesh m;
    for (const auto& face : faces_of(b)) {
        std::array<std::uint32_t, 4> corners{};
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const glm::vec3 place(face.vertices[i]);
            const auto at = std::find(m.positions.begin(), m.positions.end(), place) - m.positions.begin();
            corners[i] = static_cast<std::uint32_t>(at);
            if (corners[i] == m.positions.size())
                m.positions.push_back(place);
        }
        m.triangles.emplace_back(corners[0], corners[1], corners[2]);
        m.triangles.emplace_back(corners[0], corners[2], corners[3]);
    }
    return m;
}

mesh mesh_of(const sphere& s)
{
    return placed_about(sphere_mesh(s.radius, -s.radius, s.radius, whole_turn), glm::dmat3(1), s.center);
}

mesh mesh_of(const cylinder& x)
{
    return placed_about(
        cylinder_mesh(x.radius, 0, glm::length(x.top - x.base), whole_turn), frame_about(x.top - x.base), x.base);
}

mesh mesh_of(const cone& x)
{
    const double height = glm::length(x.apex - x.base);
    return placed_about(
        tessellated(
            parts_around, 1,
            [&](double u, double v) { return x.radius * (1 - v) * spoke(u) + dvec3(0, 0, v * height); },
            [&](double u, double) { return glm::normalize(height * spoke(u) + dvec3(0, 0, x.radius)); }),
        frame_about(x.apex - x.base), x.base);
}

mesh mesh_of(const paraboloid& x)
{
    const double height = glm::length(x.rim - x.vertex);
    return placed_about(
        tessellated(
            parts_around, parts_along,
            [&](double u, double v) { return x.radius * v * spoke(u) + dvec3(0, 0, v * v * height); },
            [&](double u, double v) { return glm::normalize(2 * height * v * spoke(u) - dvec3(0, 0, x.radius)); }),
        frame_about(x.rim - x.vertex), x.vertex);
}

mesh mesh_of(const disk& d)
{
    auto m = placed_about(disk_mesh(0, d.radius, 0, whole_turn), frame_about(d.normal), d.center);
    m.normals.clear(); // it is flat
    return m;
}

} // namespace photongrid
