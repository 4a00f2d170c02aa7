// How visible the differences of two pictures are: FLIP.
#pragma once

#include <photongrid/render/image.hpp>

#include <glm/vec3.hpp>

#include <vector>

namespace photongrid {

/// Pixels per degree of the eye's field on a screen 0.7 m wide, of 3840 pixels, seen from 0.7 m.
inline constexpr double usual_pixels_per_degree = 67;

/// What somebody sees flicker who switches between two pictures.
struct flip_map {
    std::vector<float> values; ///< of each pixel, row by row from the top left: 0, no difference, to 1
    double mean = 0;           ///< of all pixels
};

/// The visible difference of the pictures as a screen shows them, LDR-FLIP (Andersson, Nilsson, Akenine-Möller,
/// Oskarsson, Åström and Fairchild 2020, FLIP: A Difference Evaluator for Alternating Images): of their 8-bit sRGB
/// values at `exposure`, EV. Details finer than the eye resolves are filtered away, so the value depends on
/// `pixels_per_degree`, 1 to 1000. The order of the pictures does not matter. Beyond its edges a picture continues as
/// at the edge. Pixels that are not finite are black.
/// \throws std::invalid_argument if the sizes differ, or for other pixels per degree.
flip_map flip_difference(
    const image& a, const image& b, double exposure = 0, double pixels_per_degree = usual_pixels_per_degree);

namespace detail {
    /// CIE L*a*b* of linear sRGB values from 0 to 1, with the white of the screen as its white.
    glm::dvec3 cielab(const glm::dvec3& linear);
} // namespace detail

} // namespace photongrid
