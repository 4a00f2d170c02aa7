// Errors of a picture, compared with a reference.
#pragma once

#include <photongrid/render/image.hpp>

#include <cstdint>

namespace photongrid {

/// What relMSE adds to the radiance that it divides by.
inline constexpr double relmse_floor = 0.01;

/// The errors of picture a against the reference b, over all channels of the pixels that are finite in both.
struct image_difference {
    double mse = 0;               ///< mean of (a - b)^2
    double relmse = 0;            ///< mean of (a - b)^2 / (b + relmse_floor)^2, as pbrt's MRSE
    double largest = 0;           ///< largest |a - b|
    std::uint32_t x = 0, y = 0;   ///< its pixel
    std::uint64_t compared = 0;   ///< pixels compared
    std::uint64_t not_finite = 0; ///< pixels skipped
};

/// The means of blocks of n x n pixels. A rest at the right and the lower edge, less than a block, is left out.
/// \throws std::invalid_argument for n = 0, or a picture that has no whole block.
image averaged(const image& picture, std::uint32_t n);

namespace detail {
    /// \throws std::invalid_argument if the sizes differ.
    void require_same_size(const image& a, const image& b);
} // namespace detail

/// \throws std::invalid_argument if the sizes differ.
image_difference compare_images(const image& a, const image& b);

/// The relMSE against the reference b that noise makes in a, and as much in a picture like a with another seed: half
/// the mean of (a - other)^2 / (b + relmse_floor)^2, over the pixels that are finite in all. What a's relMSE has more
/// is bias, and b's own error. \throws std::invalid_argument if the sizes differ.
double noise_of_two(const image& a, const image& other, const image& b);

} // namespace photongrid
