// Indexed triangles.
#pragma once

#include <photongrid/core/kernel.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A surface of triangles.
struct mesh {
    std::vector<glm::vec3> positions;  ///< of the vertices, from `origin`, m
    std::vector<glm::uvec3> triangles; ///< the indices of each one's corners
    std::vector<glm::vec3> normals{};  ///< for shading, of the vertices, of any length; empty: triangles look flat
    std::vector<glm::vec2>
        texture_coordinates{};       ///< of the vertices; (0, 0) is a texture's lower left corner; or empty
    std::vector<glm::vec3> colors{}; ///< of the vertices, linear rgb, 0 to 1: factors on the reflectance; or empty
    glm::dvec3 origin{0};            ///< m; near the vertices, where these are too far from 0 for single precision

    bool operator==(const mesh&) const = default;
};

/// Sets the positions of a mesh, m, which are rounded to single precision: from 0, or where they are further from 0
/// than 256 m and 16 times their extent, from an origin near them.
inline void set_positions(mesh& m, std::span<const glm::dvec3> places)
{
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto& p : places) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const auto largest = [](const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
    const double extent = largest(high - low), far = std::max(largest(low), largest(high));
    m.origin = glm::dvec3(0);
    if (far > 256 && far > 16 * extent && std::isfinite(extent)) {
        // Of few bits, so that differences from it are exact.
        const double step = extent > 0 ? std::exp2(std::ceil(std::log2(extent))) : 1;
        m.origin = glm::round(low / step) * step;
    }
    m.positions.clear();
    m.positions.reserve(places.size());
    for (const auto& p : places)
        m.positions.emplace_back(p - m.origin);
}

/// The corners of a triangle, from the mesh's origin, m. Its index must be valid, and so must be the indices of its
/// corners.
inline std::array<glm::vec3, 3> corners_of(const mesh& m, std::size_t triangle)
{
    const auto& t = m.triangles[triangle];
    return {m.positions[t.x], m.positions[t.y], m.positions[t.z]};
}

/// \throws std::invalid_argument for an index of a vertex that does not exist, a coordinate of a vertex or of the
///         origin that is not finite or above 10^18 m, normals that are not finite, texture coordinates above 10^6,
///         colors outside of 0 to 1, or not as many of these as positions.
inline void check(const mesh& m)
{
    constexpr float most = 1e18f; // m; squares of distances must be finite
    for (std::size_t v = 0; v < m.positions.size(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(m.positions[v][axis]) <= most))
                throw std::invalid_argument("mesh: positions[" + std::to_string(v) + "]: coordinate "
                    + std::to_string(axis) + " is " + std::to_string(m.positions[v][axis])
                    + "; expected a number between -10^18 and 10^18");
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(m.origin[axis]) <= static_cast<double>(most)))
            throw std::invalid_argument("mesh: origin: must be between -10^18 and 10^18");
    const auto require_as_many = [&](const char* name, std::size_t size) {
        if (size != 0 && size != m.positions.size())
            throw std::invalid_argument(std::string("mesh: ") + name + ": there are " + std::to_string(size)
                + " of them and " + std::to_string(m.positions.size()) + " positions; expected one for each, or none");
    };
    require_as_many("normals", m.normals.size());
    require_as_many("texture_coordinates", m.texture_coordinates.size());
    require_as_many("colors", m.colors.size());
    for (std::size_t v = 0; v < m.texture_coordinates.size(); ++v)
        if (const auto& at = m.texture_coordinates[v]; !(std::abs(at.x) <= 1e6f && std::abs(at.y) <= 1e6f))
            throw std::invalid_argument(
                "mesh: texture_coordinates[" + std::to_string(v) + "]: must be from -10^6 to 10^6");
    for (std::size_t v = 0; v < m.colors.size(); ++v)
        for (int c = 0; c < 3; ++c)
            if (!(m.colors[v][c] >= 0 && m.colors[v][c] <= 1))
                throw std::invalid_argument("mesh: colors[" + std::to_string(v) + "]: must be from 0 to 1");
    for (std::size_t v = 0; v < m.normals.size(); ++v)
        if (!std::isfinite(m.normals[v].x) || !std::isfinite(m.normals[v].y) || !std::isfinite(m.normals[v].z))
            throw std::invalid_argument("mesh: normals[" + std::to_string(v) + "]: is not finite");
    for (std::size_t t = 0; t < m.triangles.size(); ++t)
        for (int corner = 0; corner < 3; ++corner)
            if (m.triangles[t][corner] >= m.positions.size())
                throw std::invalid_argument("mesh: triangles[" + std::to_string(t) + "]: corner "
                    + std::to_string(corner) + " is vertex " + std::to_string(m.triangles[t][corner]) + "; there are "
                    + std::to_string(m.positions.size()));
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
