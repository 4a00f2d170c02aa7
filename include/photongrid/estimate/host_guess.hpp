// Host counterpart of kth_guess.glsl. Not shared: a wrong guess only costs time, and editing the kernel then does not
// recompile host code.
#pragma once

#include <photongrid/map/grid.kernel.hpp>

#include <algorithm>
#include <span>

#include <glm/gtc/constants.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// The number of photons in a box of cells. `cells`: first photon and count of each.
inline uint photons_inside(
    const kernels::Grid& g, std::span<const glm::uvec2> cells, const glm::uvec3& low, const glm::uvec3& high)
{
    uint held = 0;
    for (uint z = low.z; z <= high.z; ++z)
        for (uint y = low.y; y <= high.y; ++y) {
            const uint row = kernels::cell_number(g, 0, y, z);
            held += cells[row + high.x].x + cells[row + high.x].y - cells[row + low.x].x;
        }
    return held;
}

/// The guess, m^2, at most max_radius2: from boxes of cells around p, each about twice as wide as the one before, until
/// one holds enough photons. Photons lie on surfaces, so their number is taken as proportional to the box's largest
/// face.
inline float guessed_radius2(
    const kernels::Grid& g, std::span<const glm::uvec2> cells, const glm::vec3& p, uint k, float max_radius2)
{
    const float sought = 4 / glm::pi<float>() * static_cast<float>(k); // in the square around a disc of k photons
    const glm::uvec3 c(kernels::cell_coordinates(g, glm::vec4(p, 1))), last(glm::uvec3(g.resolution) - 1u);
    float inside = 0, inside_area = 0; // photons and area of the box before
    for (uint half_width = 1;; half_width *= 2) {
        const auto low = c - glm::min(c, glm::uvec3(half_width)), high = glm::min(c + half_width, last);
        const auto size = high - low + 1u;
        if (size.y > 1023 || size.y * size.z > 1023)
            return max_radius2; // counting would take longer than searching
        const auto held = static_cast<float>(photons_inside(g, cells, low, high));
        const auto side = glm::vec3(size) * glm::vec3(g.cell);
        const float area = std::max({side.x * side.y, side.y * side.z, side.z * side.x});
        const bool everything = low == glm::uvec3(0) && high == last;
        if (held > inside && (held >= sought || everything)) {
            const float square = inside_area + (area - inside_area) * (sought - inside) / (held - inside);
            return std::clamp(0.25f * square, 0.0f, max_radius2);
        }
        if (everything)
            return max_radius2;
        inside = held;
        inside_area = area;
    }
}

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
