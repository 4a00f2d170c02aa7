// The pixels that a pass over a view draws, and the eye rays that it keeps for the next one.
#pragma once

#include <photongrid/render/scene_map.hpp>
#include <photongrid/trace/eye_rays.hpp>

#include <optional>
#include <vector>

namespace photongrid {

/// The bias of pixels, and the moments that find steps of the light (estimate_biases): sums over eye rays as those of
/// the light, W/(m^2 sr). Empty if they are not reported.
template <backend B>
struct pixel_biases {
    buffer_of<B, glm::vec4> bias; ///< rgb
    buffer_of<B, glm::vec4> tilt; ///< xyz
    buffer_of<B, glm::vec4> jump; ///< xyz
};

/// The pixels to which a pass adds light, row by row as in `raster`.
template <backend B>
struct canvas {
    detail::raster raster;
    uint rays = 0;                  ///< eye rays per pixel added so far, counting each combination of Fresnel branches
    buffer_of<B, glm::vec4> pixels; ///< rgb: radiance, W/(m^2 sr)
    buffer_of<B, glm::vec4> searches; ///< sums: photons used, radius, photons visited, searches
    buffer_of<B, glm::vec4> errors;   ///< x: sum of relative errors; empty without layers
    pixel_biases<B> biases{};
};

/// One eye ray per pixel: its hit, and the direct light there.
template <backend B>
struct eye_samples {
    detail::eye_hits<B> hits;
    buffer_of<B, glm::vec4> direct; ///< irradiance, W/m^2
};

/// The eye rays of the first sample, one set for each combination of Fresnel branches, which the next pass over the
/// same pixels can use again.
template <backend B>
using kept_samples = std::vector<std::optional<eye_samples<B>>>;

} // namespace photongrid
