// The camera.
#pragma once

#include <photongrid/scene/check.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A pinhole camera.
struct camera {
    dvec3 position{0};        ///< m
    dvec3 look_at{0, 0, -1};  ///< m; the point at the centre of the picture
    dvec3 up{0, 1, 0};        ///< the direction that is up in the picture; not parallel to the line of sight
    double vertical_fov = 45; ///< degrees between the picture's lower and upper edges, above 0 and below 179

    bool operator==(const camera&) const = default;
};

namespace detail {
    /// A camera's axes, unit vectors.
    struct camera_axes {
        dvec3 forward, right, up;

        explicit camera_axes(const camera& c)
            : forward(glm::normalize(c.look_at - c.position)), right(glm::normalize(glm::cross(forward, c.up))),
              up(glm::cross(right, forward))
        {
        }
    };
} // namespace detail

/// \throws std::invalid_argument for a camera without a direction of view, whose `up` is parallel to its line of sight,
///         or with a field of view outside 0 to 179 degrees.
inline void check(const camera& c)
{
    detail::require(detail::finite(c.position) && detail::finite(c.look_at), "position and look_at: must be finite");
    detail::require(c.position != c.look_at, "position and look_at: must be different points");
    detail::require(detail::finite(c.up)
            && glm::length(glm::cross(c.up, c.look_at - c.position))
                > 1e-9 * glm::length(c.up) * glm::length(c.look_at - c.position)
            && glm::length(c.up) > 0,
        "up: must be finite, not zero, and not parallel to the line of sight");
    detail::require(detail::finite(c.vertical_fov) && c.vertical_fov > 0 && c.vertical_fov < 179,
        "vertical_fov: must be between 0 and 179 degrees");
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
