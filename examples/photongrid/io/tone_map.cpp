#include <photongrid/io/tone_map.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace photongrid {

std::optional<double> fitting_exposure(const image& picture)
{
    std::vector<double> stops;
    for (const auto& p : picture.pixels) {
        const glm::dvec3 c(p);
        const double luminance = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; // of sRGB's primaries
        if (luminance > 0 && std::isfinite(luminance))
            stops.push_back(std::log2(luminance));
    }
    if (stops.empty())
        return std::nullopt;
    const auto bright = stops.begin() + static_cast<std::ptrdiff_t>(stops.size() * 19 / 20);
    std::nth_element(stops.begin(), bright, stops.end());
    const double least = *bright - 6;
    double sum = 0, lit = 0;
    for (const double s : stops)
        if (s >= least) {
            sum += s;
            ++lit;
        }
    return std::log2(0.18) - sum / lit;
}

double exposure_for(const image& picture, std::optional<double> set)
{
    return set ? *set : std::clamp(fitting_exposure(picture).value_or(0.0), -64.0, 64.0);
}

unsigned char tone_mapped(float linear, double exposure)
{
    const double v = static_cast<double>(linear) * std::exp2(exposure);
    if (!(v > 0)) // NaN too
        return 0;
    const double c = std::min(v, 1.0);
    const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    return static_cast<unsigned char>(std::lround(255 * encoded));
}

float linear_of(float encoded)
{
    static const auto all = [] {
        std::vector<float> values(65536);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double v = static_cast<double>(i) / 65535;
            values[i] = static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
        }
        return values;
    }();
    return all[static_cast<std::size_t>(std::lround(std::clamp(encoded, 0.0f, 1.0f) * 65535.0f))];
}

float linear_value(unsigned char encoded) { return linear_of(static_cast<float>(encoded) / 255.0f); }

tone_map::tone_map(double exposure)
{
    // Positive floats have the order of their bits.
    for (unsigned step = 0; step < steps_.size(); ++step) {
        std::uint32_t low = 0, high = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());
        while (low < high) {
            const auto middle = low + (high - low) / 2;
            if (tone_mapped(std::bit_cast<float>(middle), exposure) > step)
                high = middle;
            else
                low = middle + 1;
        }
        steps_[step] = std::bit_cast<float>(high);
    }
}

} // namespace photongrid
