// Boxes along the axes of the scene's coordinates.
#pragma once

#include <photongrid/scene/check.hpp>

#include <limits>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// The least box along x, y and z that holds what was added, m.
struct bounds {
    dvec3 low{std::numeric_limits<double>::infinity()};   ///< m
    dvec3 high{-std::numeric_limits<double>::infinity()}; ///< m

    /// Adds a box about p that reaches `margin` to each side.
    void add(const dvec3& p, const dvec3& margin = dvec3(0))
    {
        low = glm::min(low, p - margin);
        high = glm::max(high, p + margin);
    }
    /// True when nothing was added.
    bool empty() const { return !(low.x <= high.x); }
};

namespace detail {
    /// How far a disc of radius r about an axis reaches along x, y and z.
    inline dvec3 disc_extent(const dvec3& axis, double r)
    {
        const dvec3 a = glm::normalize(axis);
        return r * glm::sqrt(glm::max(dvec3(0), dvec3(1) - a * a));
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
