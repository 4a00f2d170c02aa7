// Helpers for checking the parts of a scene.
#pragma once

#include <glm/glm.hpp>

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Scenes are in double precision: positions in m, powers in W, or directions.
using glm::dvec3;

namespace detail {
    inline void require(bool good, const std::string& what)
    {
        if (!good)
            throw std::invalid_argument(what);
    }
    inline bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
    inline bool finite(double v) { return std::isfinite(v); }
    inline void require_radius(double r) { require(finite(r) && r > 0, "radius: must be finite and greater than 0"); }
    inline void require_direction(const dvec3& d)
    {
        require(finite(d) && glm::length(d) > 0, "direction: must be finite and not 0");
    }
    /// A number with at most nine digits.
    inline std::string text_of(double v)
    {
        char digits[32];
        return {digits, std::to_chars(digits, digits + sizeof digits, v, std::chars_format::general, 9).ptr};
    }
    inline void require_axis(const dvec3& a, const dvec3& b, const char* what)
    {
        require(finite(a) && finite(b), std::string(what) + ": must be finite");
        require(glm::length(b - a) > 0, std::string(what) + ": must be different points");
    }
} // namespace detail

/// A range of numbers, both ends included. check() throws std::invalid_argument "name: must be from …".
struct real_range {
    double least, most;
    const char* unit; ///< with a leading space
    bool has(double v) const { return v >= least && v <= most; }
    /// "-64 to 64 EV"
    std::string ends() const { return detail::text_of(least) + " to " + detail::text_of(most) + unit; }
    void check(const char* name, double v) const
    {
        detail::require(has(v), std::string(name) + ": must be from " + ends());
    }
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
