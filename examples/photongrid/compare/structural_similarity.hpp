// How alike two pictures look.
#pragma once

#include <photongrid/render/image.hpp>

namespace photongrid {

/// The mean structural similarity of the pictures as a screen shows them (Wang, Bovik, Sheikh and Simoncelli 2004,
/// Image Quality Assessment: From Error Visibility to Structural Similarity): of the luma of their 8-bit sRGB values at
/// `exposure`, EV, with a Gaussian window of 11 x 11 pixels and sigma = 1.5, K1 = 0.01 and K2 = 0.03. 1: they look the
/// same; 0: they have nothing in common. At the edges of the picture the window is cut. Pixels that are not finite are
/// black. \throws std::invalid_argument if the sizes differ.
double structural_similarity(const image& a, const image& b, double exposure = 0);

} // namespace photongrid
