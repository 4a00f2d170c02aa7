// Pictures on disk: PNG for looking at, EXR and PFM for measuring. docs/guide/scenes.md describes the tone map.
#pragma once

#include <photongrid/render/image.hpp>
#include <photongrid/scene/scene.hpp>

#include <array>
#include <map>
#include <stdexcept>
#include <string>

namespace photongrid {

/// A file that cannot be read or written: "path: reason".
struct file_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What an EXR says about its making, by attribute name.
using image_notes = std::map<std::string, std::string>;

/// Throws file_error when `path` does not end in .png, .exr or .pfm, or its folder does not take files: said before
/// hours of rendering, not after.
void check_image_path(const std::string& path);

/// The same for any file, whatever its ending.
void check_file_path(const std::string& path);

/// Whether the format of `path`'s ending holds image::layers: EXR does.
bool holds_layers(const std::string& path);

/// Writes a picture in the format of its ending. All or nothing: on an error, or when the program dies, `path` is
/// what it was before. `exposure` (EV) is used by PNG only. EXR holds the picture's layers too, as single precision
/// channels estimate.radius (m), estimate.count, estimate.relative_error and, of several passes, noise; PNG and PFM
/// leave them out. Throws file_error.
void write_image(const std::string& path, const image& picture, double exposure = 0, const image_notes& notes = {});

/// Reads an EXR or PFM file; of an EXR's channels R, G and B alone. Throws file_error.
image read_image(const std::string& path);

/// Writes bytes by way of a temporary file beside `path`. Throws file_error.
void write_file(const std::string& path, const std::string& bytes);

/// Linear radiance to an 8-bit sRGB value: clamp(2^exposure * linear, 0, 1) through the sRGB transfer function.
unsigned char tone_mapped(float linear, double exposure);

/// The same for many values at one exposure, bit for bit, some twenty times as fast: by the values at which it changes.
class tone_map {
public:
    explicit tone_map(double exposure);
    unsigned char operator()(float linear) const
    {
        if (!(linear > 0)) // NaN too
            return 0;
        unsigned n = 0; // of the steps, those at or below `linear`
        for (unsigned half = 128; half > 0; half /= 2)
            n += steps_[n + half - 1] <= linear ? half : 0;
        return static_cast<unsigned char>(n);
    }

private:
    std::array<float, 255> steps_{}; ///< the smallest value that becomes 1, 2, …
};

/// How far picture a is from the reference b, over all channels of the pixels that are finite in both.
struct image_difference {
    double mse = 0;               ///< mean of (a - b)^2
    double relmse = 0;            ///< mean of (a - b)^2 / (b + 0.01)^2, as pbrt's MRSE
    double largest = 0;           ///< largest |a - b|
    std::uint32_t x = 0, y = 0;   ///< where that is
    std::uint64_t compared = 0;   ///< pixels
    std::uint64_t not_finite = 0; ///< pixels skipped
};

/// Throws std::invalid_argument when the sizes differ.
image_difference compare_images(const image& a, const image& b);

} // namespace photongrid
