// The boxes of a triangle_tree and of its builder, in single precision.
#pragma once

#include <array>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// A box around triangles.
struct tree_box {
    glm::vec3 low{1e30f}, high{-1e30f}; ///< m; without contents no ray meets it

    void add(const tree_box& b)
    {
        low = glm::min(low, b.low);
        high = glm::max(high, b.high);
    }
    void add(const glm::vec3& p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    /// Half of the surface, m^2; 0 of a box without contents.
    double area() const
    {
        const glm::dvec3 e = glm::dvec3(high) - glm::dvec3(low);
        return e.x < 0 ? 0 : e.x * e.y + e.y * e.z + e.z * e.x;
    }
};

/// A box as eight numbers of which all are minima, so that compilers make vector code: the lowest x, y and z, m,
/// and the highest ones with the opposite sign. The fourth and the eighth are not of the box.
struct least_box {
    alignas(16) std::array<float, 8> least;

    static least_box of_nothing() { return {{1e30f, 1e30f, 1e30f, 1e30f, 1e30f, 1e30f, 1e30f, 1e30f}}; }
    static least_box of(const glm::vec3& p) { return {{p.x, p.y, p.z, 0, -p.x, -p.y, -p.z, 0}}; }

    void add(const least_box& b)
    {
        std::array<float, 8> both; // a local: nothing overlaps it, so that the loop becomes vector code
        for (std::size_t i = 0; i < 8; ++i)
            both[i] = b.least[i] < least[i] ? b.least[i] : least[i];
        least = both;
    }
    /// As tree_box::area().
    double area() const { return box().area(); }
    tree_box box() const { return {{least[0], least[1], least[2]}, {-least[4], -least[5], -least[6]}}; }
};

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
