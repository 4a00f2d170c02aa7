#include <photongrid/compare/false_colors.hpp>
#include <photongrid/io/tone_map.hpp>

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

namespace photongrid::false_colors {

namespace {
    using srgb_color = glm::vec<3, unsigned char>;

    // Rounded from L* = 2 + 95 t with hues from 285 to 460 degrees in CIE L*a*b*, as colourful as sRGB allows.
    constexpr srgb_color heat_colors[] = {{4, 6, 21}, {13, 21, 54}, {27, 27, 87}, {55, 28, 117}, {92, 16, 144},
        {137, 1, 131}, {170, 0, 118}, {202, 0, 106}, {233, 1, 87}, {255, 42, 69}, {255, 94, 63}, {255, 128, 60},
        {255, 157, 59}, {255, 182, 82}, {255, 205, 111}, {255, 227, 150}, {255, 247, 209}};
    constexpr srgb_color balance_colors[] = {
        {5, 30, 110}, {40, 100, 200}, {140, 185, 235}, {246, 246, 246}, {240, 170, 140}, {205, 70, 60}, {105, 5, 30}};

    /// The colour at t, 0 to 1, between those of a scale, as encoded values are.
    glm::vec3 between(std::span<const srgb_color> scale, double t)
    {
        if (std::isnan(t))
            return not_finite;
        const double place = std::clamp(t, 0.0, 1.0) * static_cast<double>(scale.size() - 1);
        const auto first = std::min(static_cast<std::size_t>(place), scale.size() - 2);
        const glm::dvec3 encoded
            = glm::mix(glm::dvec3(scale[first]), glm::dvec3(scale[first + 1]), place - static_cast<double>(first));
        const auto linear = [](double v) { return linear_value(static_cast<unsigned char>(std::lround(v))); };
        return {linear(encoded.x), linear(encoded.y), linear(encoded.z)};
    }
} // namespace

glm::vec3 heat(double t) { return between(heat_colors, t); }

glm::vec3 balance(double t) { return between(balance_colors, (t + 1) / 2); }

} // namespace photongrid::false_colors
