// What lights emit: its check, and the power that reaches a scene.
#pragma once

#include <photongrid/scene/bounds.hpp>

#include <cstddef>
#include <glm/vec4.hpp>
#include <string>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// \throws std::invalid_argument for an emission (power, irradiance or radiance, rgb) with a channel that is not finite
///         or negative, or of 0. `name`: the member's, for the message.
inline void check_emission(const std::string& name, const dvec3& emission)
{
    detail::require(detail::finite(emission) && emission.x >= 0 && emission.y >= 0 && emission.z >= 0,
        name + ": each channel must be finite and not negative");
    detail::require(emission.x + emission.y + emission.z > 0, name + ": is 0; a light needs a channel above 0");
}

/// How samples of a light differ, as seen from a point: see kernels::SAMPLED_ONCE and the others.
enum class light_samples { once, by_area, by_solid_angle, by_direction };

/// A ball that holds a light.
struct light_ball {
    dvec3 center{0};
    double radius = 0; ///< m
    double power = 0;  ///< W, of all channels together
};

/// What the record of a light takes from the scene.
struct light_context {
    bounds box;                     ///< through whose faces light from outside enters
    std::size_t first_triangle = 0; ///< number of a mesh light's first one, among all of the scene
};

namespace detail {
    /// The power of a light, W, rgb. Of a light outside of the scene, which has none of its own: what enters `box`.
    template <class Kind, class Light>
    dvec3 power_of(Kind, const Light& l, const bounds& box)
    {
        if constexpr (requires { Kind::power_into(box, l); })
            return Kind::power_into(box, l);
        else
            return l.power;
    }

    /// The xyz of a record.
    inline dvec3 vector_of(const glm::vec4& record) { return dvec3(glm::vec3(record)); }
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
