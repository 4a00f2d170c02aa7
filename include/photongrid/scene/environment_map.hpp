// Pictures of light from all directions.
#pragma once

#include <photongrid/scene/check.hpp>

#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The radiance from all directions, by longitude (columns) and latitude (rows, from the top, where y is largest). A
/// texel has one radiance over all of it. The middle of the picture is in the direction of +z, a quarter of it further
/// to the right is -x: seen from inside, with y upwards, it is as it is in the file.
struct environment_map {
    std::uint32_t width = 1, height = 1;
    std::vector<glm::vec3> radiance{glm::vec3(1)}; ///< width x height, row by row; rgb, none negative

    bool operator==(const environment_map&) const = default;
};

/// The most texels of an environment_map.
inline constexpr std::uint32_t max_environment_texels = 1u << 25;

/// \throws std::invalid_argument for a size that is not that of `radiance`, or 0, or above the limit; for a radiance
///         that is not finite or negative; or if all are 0.
inline void check(const environment_map& m)
{
    const std::size_t texels = std::size_t{m.width} * m.height;
    detail::require(texels <= max_environment_texels, "map: has more than 2^25 texels; make it smaller");
    detail::require(texels > 0 && m.radiance.size() == texels, "map: must have width x height texels, at least one");
    bool lit = false;
    for (const auto& l : m.radiance) {
        detail::require(
            std::isfinite(l.x) && std::isfinite(l.y) && std::isfinite(l.z) && l.x >= 0 && l.y >= 0 && l.z >= 0,
            "map: each radiance must be finite and not negative");
        lit = lit || l.x + l.y + l.z > 0;
    }
    detail::require(lit, "map: is black; a light needs a texel above 0");
}

/// The direction, a unit vector, at a place of a map: u from 0 to 1 along a row, v from 0 to 1 down a column.
inline dvec3 environment_direction(double u, double v)
{
    const double longitude = 2 * std::numbers::pi * u, colatitude = std::numbers::pi * v;
    return {
        std::sin(longitude) * std::sin(colatitude), std::cos(colatitude), -std::cos(longitude) * std::sin(colatitude)};
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
