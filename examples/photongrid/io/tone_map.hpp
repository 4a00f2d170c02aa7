// Tone mapping to 8 bits.
#pragma once

#include <photongrid/render/image.hpp>

#include <array>
#include <optional>

namespace photongrid {

/// The exposure, EV, at which the geometric mean of the luminance of all lit pixels becomes 0.18, middle grey (Reinhard
/// et al. 2002, Photographic Tone Reproduction for Digital Images); none for a black picture. A pixel is lit if it is
/// at most 6 EV darker than the 95th percentile: the dark around a spotlight does not burn out what it lights.
std::optional<double> fitting_exposure(const image& picture);

/// The exposure, EV, at which a picture is shown: the one that is set, or the fitting one; 0 for a black picture.
double exposure_for(const image& picture, std::optional<double> set);

/// Linear radiance to an 8-bit sRGB value: clamp(2^exposure * linear, 0, 1) through the sRGB transfer function
/// (IEC 61966-2-1).
unsigned char tone_mapped(float linear, double exposure);

/// The linear value, 0 to 1, of an 8-bit sRGB value.
float linear_value(unsigned char encoded);

/// The same of an encoded value from 0 to 1, to 16 bits.
float linear_of(float encoded);

/// tone_mapped() for many values at one exposure, about twenty times as fast, by a table of the values at which the
/// result changes.
class tone_map {
public:
    explicit tone_map(double exposure);
    unsigned char operator()(float linear) const
    {
        if (!(linear > 0)) // NaN too
            return 0;
        unsigned n = 0; // number of steps at or below `linear`
        for (unsigned half = 128; half > 0; half /= 2)
            n += steps_[n + half - 1] <= linear ? half : 0;
        return static_cast<unsigned char>(n);
    }

private:
    std::array<float, 255> steps_{}; ///< the smallest value that becomes 1, 2, …
};

} // namespace photongrid
