#include <photongrid/io/import/tessellation.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace photongrid {

namespace {
    constexpr unsigned around = 128, upwards = 64;

    constexpr double full_turn = 2 * std::numbers::pi;

    /// As `around` for a full turn.
    unsigned around_for(double angle)
    {
        return std::max(4u, static_cast<unsigned>(std::ceil(around * std::abs(angle) / full_turn)));
    }

    /// The angle about the axis at u. The end of a full turn is its beginning, bit for bit, so that nothing gapes
    /// there.
    double longitude_at(double u, double angle) { return u == 1 && angle == full_turn ? 0 : u * angle; }
} // namespace

mesh tessellated(unsigned across, unsigned along, const std::function<glm::dvec3(double, double)>& place,
    const std::function<glm::dvec3(double, double)>& normal)
{
    mesh made;
    for (unsigned j = 0; j <= along; ++j)
        for (unsigned i = 0; i <= across; ++i) {
            const double u = static_cast<double>(i) / across, v = static_cast<double>(j) / along;
            made.positions.emplace_back(place(u, v));
            made.texture_coordinates.emplace_back(u, v);
            if (normal)
                made.normals.emplace_back(normal(u, v));
        }
    const std::uint32_t row = across + 1;
    for (std::uint32_t j = 0; j < along; ++j)
        for (std::uint32_t i = 0; i < across; ++i) {
            const std::uint32_t first = j * row + i;
            made.triangles.emplace_back(first, first + 1, first + row + 1);
            made.triangles.emplace_back(first, first + row + 1, first + row);
        }
    return made;
}

mesh sphere_mesh(double radius, double low, double high, double angle)
{
    const double from = std::asin(std::clamp(low / radius, -1.0, 1.0)),
                 to = std::asin(std::clamp(high / radius, -1.0, 1.0));
    const auto direction = [=](double u, double v) {
        const double longitude = longitude_at(u, angle), z = std::sin(from + v * (to - from)),
                     across = std::sqrt(std::max(0.0, (1 - z) * (1 + z)));
        return glm::dvec3(std::cos(longitude) * across, std::sin(longitude) * across, z);
    };
    return tessellated(
        around_for(angle), upwards, [=](double u, double v) { return radius * direction(u, v); }, direction);
}

mesh cylinder_mesh(double radius, double low, double high, double angle)
{
    const auto direction = [=](double u) {
        const double longitude = longitude_at(u, angle);
        return glm::dvec3(std::cos(longitude), std::sin(longitude), 0);
    };
    return tessellated(
        around_for(angle), 1,
        [=](double u, double v) { return radius * direction(u) + glm::dvec3(0, 0, low + v * (high - low)); },
        [=](double u, double) { return direction(u); });
}

mesh disk_mesh(double height, double radius, double inner_radius, double angle)
{
    // Around the edge d place / du, inwards d place / dv: their cross product is +z.
    return tessellated(
        around_for(angle), 1,
        [=](double u, double v) {
            const double r = radius + v * (inner_radius - radius), longitude = longitude_at(u, angle);
            return glm::dvec3(r * std::cos(longitude), r * std::sin(longitude), height);
        },
        nullptr);
}

mesh with_corner_coordinates(const mesh& m, const std::array<glm::vec2, 3>& corners)
{
    mesh made;
    made.origin = m.origin;
    for (const auto& t : m.triangles) {
        for (int c = 0; c < 3; ++c) {
            made.positions.push_back(m.positions[t[c]]);
            if (!m.normals.empty())
                made.normals.push_back(m.normals[t[c]]);
            if (!m.colors.empty())
                made.colors.push_back(m.colors[t[c]]);
            made.texture_coordinates.push_back(corners[static_cast<std::size_t>(c)]);
        }
        const auto n = static_cast<std::uint32_t>(made.positions.size());
        made.triangles.emplace_back(n - 3, n - 2, n - 1);
    }
    return made;
}

} // namespace photongrid
