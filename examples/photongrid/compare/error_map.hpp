// Where a picture differs from a reference, and by how much.
#pragma once

#include <photongrid/render/image.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace photongrid {

/// The error of a pixel.
struct pixel_error {
    /// Relative error: the root of the mean over channels of (a - b)^2 / (b + relmse_floor)^2, so that the mean of its
    /// square over pixels is relMSE (image_difference.hpp). NaN where a picture is not finite.
    double relative = 0;
    double luminance = 0; ///< of the picture, W/(m^2 sr)
    double reference = 0; ///< luminance of the reference

    /// The difference of luminance as a share of the reference's, with relmse_floor: above 0 if the picture is too
    /// bright.
    double brighter() const;
};

/// The luminance of a linear colour of sRGB's primaries.
double luminance_of(const glm::vec3& linear);

/// The errors of picture a against the reference b, row by row from the top left.
/// \throws std::invalid_argument if the sizes differ.
std::vector<pixel_error> pixel_errors(const image& a, const image& b);

/// Pixels of a picture that belong together.
struct picture_region {
    std::string name;
    std::vector<bool> pixels; ///< whether each belongs to it
};

/// The percentiles of relative error that error_summary has.
inline constexpr std::array<int, 5> error_percentiles{50, 90, 95, 99, 100};

/// The share of pixels that error_summary::trimmed_relmse leaves out.
inline constexpr double trimmed_share = 0.001;

/// The errors of a region, over those of its pixels that are finite in both pictures. Members other than `pixels` and
/// `squares` are NaN if there are none.
struct error_summary {
    std::uint64_t pixels = 0;
    double squares = 0;        ///< sum of squared relative errors
    double relmse = 0;         ///< their mean
    double trimmed_relmse = 0; ///< their mean without the largest 0.1 %, rounded up; of one pixel, without none
    double mean = 0;           ///< luminance of the picture, W/(m^2 sr)
    double reference_mean = 0; ///< of the reference
    double flip = 0;           ///< mean of the values of a flip_map (flip.hpp)
    /// The smallest relative errors that so many percent of the pixels do not exceed.
    std::array<double, error_percentiles.size()> percentiles{};

    /// The difference of the means as a share of the reference's: what averaging over pixels does not remove.
    double bias() const { return mean / reference_mean - 1; }
};

/// `visible`: values of a flip_map.
error_summary summary_of(
    std::span<const pixel_error> errors, std::span<const float> visible, const picture_region& region);

/// The pixels whose relative error is at least `from` and less than `to`.
struct error_bin {
    double from = 0, to = 0;
    std::uint64_t pixels = 0;
    double squares = 0; ///< sum of their squared relative errors
};

/// Bins of half a decade each from 10^-4 to 100, and one for all below and one for all above. Pixels that are not
/// finite are in none.
std::vector<error_bin> error_histogram(std::span<const pixel_error> errors);

} // namespace photongrid
