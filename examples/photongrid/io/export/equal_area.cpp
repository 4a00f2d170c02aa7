#include <photongrid/io/export/equal_area.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace photongrid {

dvec3 equal_area_direction(double u, double v)
{
    const double x = 2 * u - 1, y = 2 * v - 1;
    // In the diamond |x| + |y| < 1 is the upper half; r is 0 in the middle of each half.
    const double inside = 1 - (std::abs(x) + std::abs(y)), r = 1 - std::abs(inside);
    const double longitude
        = r == 0 ? 0 : ((std::abs(y) - std::abs(x)) / r + 1) * std::numbers::pi / 4; // of the first quadrant
    const double across = r * std::sqrt(std::max(0.0, 2 - r * r));
    return {std::copysign(std::cos(longitude), x) * across, std::copysign(std::sin(longitude), y) * across,
        std::copysign(1 - r * r, inside)};
}

std::vector<glm::vec3> equal_area_texels(const environment_light& l, std::uint32_t side)
{
    const auto& map = *l.map;
    const auto radiance_at = [&](const dvec3& d) { // inverts environment_direction
        const double turn = std::atan2(d.x, -d.z) / (2 * std::numbers::pi), u = turn < 0 ? turn + 1 : turn,
                     v = std::acos(std::clamp(d.y, -1.0, 1.0)) / std::numbers::pi;
        const auto cell = [](double c, std::uint32_t n) { return std::min(static_cast<std::uint32_t>(c * n), n - 1); };
        return dvec3(map.radiance[std::size_t{cell(v, map.height)} * map.width + cell(u, map.width)]);
    };
    constexpr std::uint32_t parts = 4;
    std::vector<glm::vec3> made;
    made.reserve(std::size_t{side} * side);
    for (std::uint32_t row = 0; row < side; ++row)
        for (std::uint32_t column = 0; column < side; ++column) {
            dvec3 sum(0);
            for (std::uint32_t part = 0; part < parts * parts; ++part) {
                const auto middle = [](std::uint32_t n) { return (n + 0.5) / parts; };
                const auto d
                    = equal_area_direction((column + middle(part % parts)) / side, (row + middle(part / parts)) / side);
                sum += radiance_at(dvec3(d.x, d.z, -d.y)); // z is up in the square
            }
            made.emplace_back(l.radiance * sum / double{parts * parts});
        }
    return made;
}

} // namespace photongrid
