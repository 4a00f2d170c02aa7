// Helpers for checking the parts of a scene.
#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <stdexcept>
#include <string>

#include <photongrid/backend/exact_begin.hpp>

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
    inline void require_axis(const dvec3& a, const dvec3& b, const char* what)
    {
        require(finite(a) && finite(b), std::string(what) + ": must be finite");
        require(glm::length(b - a) > 0, std::string(what) + ": are the same point, so the shape has no axis");
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
