// Triangles of polygons that need not be convex.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace photongrid {

/// A normal of a polygon's plane, a unit vector (Newell's method); that of z where it has no area.
glm::dvec3 normal_of_polygon(std::span<const glm::dvec3> corners);

/// Cuts polygons into triangles: fans around the first corner where these cover nothing else, else ears (Meisters
/// 1975).
class polygon_cutter {
public:
    /// The triangles of a polygon of at least three corners, two less than it has, as indices into `corners`. `normal`:
    /// that of its plane, of any length. Valid until the next call.
    std::span<const glm::uvec3> triangles_of(std::span<const glm::dvec3> corners, const glm::dvec3& normal);

    /// Of how many polygons the triangles cover more than the polygon: those that cross themselves, and, so that no
    /// file takes forever, those after the first 2^30 steps.
    std::size_t not_cut() const { return not_cut_; }

private:
    bool is_ear(std::uint32_t at) const;

    std::vector<glm::uvec3> made_;
    std::vector<glm::dvec2> plane_; ///< the corners in the polygon's plane, counterclockwise
    std::vector<std::uint32_t> before_, after_;
    std::vector<std::uint32_t> reflex_; ///< corners that may lie in others' ears
    std::size_t not_cut_ = 0;
    std::uint64_t steps_ = 0;
};

/// "2 faces have fewer than three corners, and are left out", and the like.
std::string text_of_flat_faces(std::size_t count);
std::string text_of_crossed_faces(std::size_t count);

} // namespace photongrid
