// Axis-aligned bounding boxes.
#pragma once

#include <photongrid/scene/check.hpp>

#include <limits>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The bounding box of everything that was added, m.
struct bounds {
    dvec3 low{std::numeric_limits<double>::infinity()};   ///< m
    dvec3 high{-std::numeric_limits<double>::infinity()}; ///< m

    /// Adds the box around p that extends by `margin` to each side.
    void add(const dvec3& p, const dvec3& margin = dvec3(0))
    {
        low = glm::min(low, p - margin);
        high = glm::max(high, p + margin);
    }
    void add(const bounds& b)
    {
        low = glm::min(low, b.low);
        high = glm::max(high, b.high);
    }
    /// Whether nothing was added.
    bool empty() const { return !(low.x <= high.x); }
};

/// The area of a box's outline as seen along `direction`, a unit vector, m^2.
inline double projected_area(const bounds& box, const dvec3& direction)
{
    const dvec3 size = box.high - box.low, d = glm::abs(direction);
    return d.x * size.y * size.z + d.y * size.z * size.x + d.z * size.x * size.y;
}

namespace detail {
    /// Half the extent of a disc of radius r, whose normal is `axis`, along x, y and z.
    inline dvec3 disc_extent(const dvec3& axis, double r)
    {
        const dvec3 a = glm::normalize(axis);
        return r * glm::sqrt(glm::max(dvec3(0), dvec3(1) - a * a));
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
