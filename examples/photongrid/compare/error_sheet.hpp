// A picture of the differences of two pictures.
#pragma once

#include <photongrid/compare/error_map.hpp>
#include <photongrid/compare/flip.hpp>

#include <span>

namespace photongrid {

/// What the colours of an error_sheet() stand for.
struct sheet_scales {
    double exposure = 0;                       ///< EV, of the two pictures
    double least_error = 1e-3, most_error = 1; ///< relative errors with the darkest and the lightest colour
    double difference = 1;                     ///< pixel_error::brighter() of the deepest red; its negative: blue
};

/// 1, 2 or 5 times a power of ten, at least 0.001, that is not exceeded by 95 % of the sizes of
/// pixel_error::brighter().
double difference_limit(std::span<const pixel_error> errors);

/// Six pictures side by side in one to three rows: the picture, the reference, the relative difference of luminance
/// (blue: too dark, red: too bright), the relative error on a logarithmic scale, FLIP, and the regions over the
/// reference, later ones over earlier ones. Below those of false colours lies their scale, with ticks: at 0 and the
/// ends of the difference, at the powers of ten of the error, at each tenth of FLIP. Pixels that are not finite are
/// green. Small pictures are enlarged. The result is linear, to be written at 0 EV.
/// \throws std::invalid_argument if sizes differ, or for an empty picture.
image error_sheet(const image& picture, const image& reference, std::span<const pixel_error> errors,
    const flip_map& visible, std::span<const picture_region> regions, const sheet_scales& scales);

/// The name of the colour in which error_sheet() draws the region of this index.
const char* region_color_name(std::size_t index);

} // namespace photongrid
