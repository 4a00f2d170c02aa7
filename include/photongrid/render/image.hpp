// Pictures.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace photongrid {

/// Properties of the estimates of a picture: means over each pixel's eye rays, row by row from the top left. 0 in
/// pixels without estimates.
struct estimate_layers {
    std::vector<float> radius; ///< m
    std::vector<float> count;  ///< photons within the radius
    /// Standard error of the irradiance, over the irradiance (sums over channels). It is the noise of the photons; that
    /// of eye rays and shadow rays is in `noise` only.
    std::vector<float> relative_error;
    std::vector<float> noise; ///< standard error of the mean of the passes, mean of the channels; empty for one pass
    /// How much too bright the blur of estimates makes a pixel on the average, W/(m^2 sr), mean of the channels; where
    /// it is found by a step of the light, the sign tells nothing (film::bias_of). Empty unless reports_bias().
    std::vector<float> bias;
};

/// A picture: linear radiance, W/(m^2 sr), rgb, row by row from the top left.
struct image {
    std::uint32_t width = 0;       ///< pixels
    std::uint32_t height = 0;      ///< pixels
    std::vector<glm::vec3> pixels; ///< width x height
    estimate_layers layers{};      ///< empty unless output_settings::aov or reports_bias()
};

} // namespace photongrid
