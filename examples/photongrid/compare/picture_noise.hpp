// The noise of a picture, estimated from the picture itself.
#pragma once

#include <photongrid/render/image.hpp>

namespace photongrid {

/// The relMSE (image_difference.hpp) that a picture has against a perfect one because of noise that differs from pixel
/// to pixel, as that of path tracing does. Blotches wider than a pixel, as photon maps have them, are not found: two
/// seeds show them.
///
/// After Immerkær, Fast Noise Variance Estimation, Computer Vision and Image Understanding 64(2), 1996: the difference
/// of two Laplacians is 0 where a picture is even or slopes, and has 36 times the variance of the noise. In each tile
/// of 16 x 16 pixels its median size is taken, so that edges count little; the result is the mean over tiles and
/// channels. Filters wider than a pixel make noise that neighbours share, of which a part is missed: average such
/// pictures first. Pixels beside one that is not finite are left out. NaN for pictures of less than 3 x 3 finite
/// pixels.
double picture_noise(const image& picture);

} // namespace photongrid
