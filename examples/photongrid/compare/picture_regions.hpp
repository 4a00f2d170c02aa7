// Parts of a picture in which errors have causes of their own.
#pragma once

#include <photongrid/compare/error_map.hpp>

namespace photongrid {

/// What a reference tells by itself, from its luminance after a median over 5 x 5 pixels, so that the noise of a
/// reference makes no regions. Every pixel is in one of edges and surfaces, and in one of dark, middle and bright,
/// unless it is not finite: such pixels are in none.
/// - edges: at most 2 pixels, across and down, from a step: a pixel about which Sobel's filter finds the luminance,
///   plus relmse_floor, changed by a factor of 1.5 or more from its one side to the other. Outlines, borders of shadows
///   and of caustics, coarse textures.
/// - surfaces: all else.
/// - dark, bright: more than 2 EV from the geometric mean of the luminance of all pixels that are not black, which
///   fitting_exposure() makes middle grey. Shadows; lamps, highlights and the brightest caustics.
/// - middle: between them.
std::vector<picture_region> regions_of(const image& reference);

/// The pixels that are brighter than `level` times the mean luminance of `picture`, or, if `outside`, those that are
/// not. A picture of caustics alone gives the region of caustics. Pixels that are not finite are in neither.
/// \throws std::invalid_argument if no pixel is in the region.
picture_region region_of(const std::string& name, const image& picture, double level, bool outside);

} // namespace photongrid
