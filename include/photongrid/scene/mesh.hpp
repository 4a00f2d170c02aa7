// Indexed triangles.
#pragma once

#include <photongrid/backend/kernel.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <glm/vec3.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// A surface of triangles.
struct mesh {
    std::vector<glm::vec3> positions;  ///< of the vertices, m
    std::vector<glm::uvec3> triangles; ///< the indices of each one's corners
    std::vector<glm::vec3> normals{};  ///< for shading, of the vertices, of any length; empty: triangles look flat

    bool operator==(const mesh&) const = default;
};

/// The corners of a triangle, m. Its index must be valid, and so must be the indices of its corners.
inline std::array<glm::vec3, 3> corners_of(const mesh& m, std::size_t triangle)
{
    const auto& t = m.triangles[triangle];
    return {m.positions[t.x], m.positions[t.y], m.positions[t.z]};
}

/// \throws std::invalid_argument for an index of a vertex that does not exist, a coordinate that is not finite or above
///         10^18 m, or normals that are not finite or not as many as positions.
inline void check(const mesh& m)
{
    constexpr float most = 1e18f; // m; squares of distances must be finite
    for (std::size_t v = 0; v < m.positions.size(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(m.positions[v][axis]) <= most))
                throw std::invalid_argument("mesh: positions[" + std::to_string(v) + "]: coordinate "
                    + std::to_string(axis) + " is " + std::to_string(m.positions[v][axis])
                    + "; expected a number between -10^18 and 10^18");
    if (!m.normals.empty() && m.normals.size() != m.positions.size())
        throw std::invalid_argument("mesh: normals: there are " + std::to_string(m.normals.size()) + " of them and "
            + std::to_string(m.positions.size()) + " positions; expected one for each, or none");
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

#include <photongrid/backend/exact_end.hpp>
