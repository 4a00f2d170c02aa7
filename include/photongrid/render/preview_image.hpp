// Enlarges a preview, which has larger pixels, to the picture's size.
#pragma once

#include <photongrid/render/image.hpp>
#include <photongrid/scene/scene.hpp>
#include <photongrid/trace/eye_rays.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// Replaces NaN and infinite pixels by black, and counts them.
inline std::vector<glm::vec3> finite_pixels(const std::vector<glm::vec4>& pixels, float scale, std::uint64_t& invalid)
{
    std::vector<glm::vec3> good;
    good.reserve(pixels.size());
    for (const auto& p : pixels) {
        const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
        invalid += finite ? 0u : 1u;
        good.push_back(finite ? glm::vec3(p) * scale : glm::vec3(0));
    }
    return good;
}

/// The two pixels of the preview, along one axis, between which a pixel of the picture lies.
struct between_pixels {
    uint low, high;
    float share; ///< weight of the higher one
};

inline between_pixels between(uint pixel, uint divisor, uint count)
{
    const float at = std::max(0.0f, (static_cast<float>(pixel) + 0.5f) / static_cast<float>(divisor) - 0.5f);
    const uint low = std::min(static_cast<uint>(at), count - 1);
    return {low, std::min(low + 1, count - 1), at - static_cast<float>(low)};
}

/// One over the mean of pixels' largest channels; 1 for black ones.
inline float scale_of(const std::vector<glm::vec3>& pixels)
{
    double sum = 0;
    for (const auto& p : pixels)
        sum += static_cast<double>(std::max({p.x, p.y, p.z}));
    const auto scale = static_cast<float>(static_cast<double>(pixels.size()) / sum);
    return std::isnormal(scale) ? scale : 1.0f;
}

/// Pixels as an image of the picture's size, multiplied by `scale`. Values are interpolated between the centres of
/// larger pixels, as v / (1 + v) after exposure, so that a lamp does not brighten its neighbours.
inline image to_image(const std::vector<glm::vec4>& pixels, const raster& r, const render_settings& s, float scale,
    std::uint64_t& invalid)
{
    image out;
    out.width = s.output.width;
    out.height = s.output.height;
    invalid = 0;
    auto good = finite_pixels(pixels, scale, invalid);
    if (r.divisor == 1) {
        out.pixels = std::move(good);
        return out;
    }
    out.pixels.reserve(std::size_t{s.output.width} * s.output.height);
    std::vector<between_pixels> columns;
    for (uint x = 0; x < s.output.width; ++x)
        columns.push_back(between(x, r.divisor, r.width));
    const float exposure = s.output.exposure ? static_cast<float>(std::exp2(*s.output.exposure)) : scale_of(good);
    for (auto& p : good)
        p = glm::min(p / (1.0f + p * exposure), 0.999999f / exposure);
    for (uint y = 0; y < s.output.height; ++y) {
        const auto row = between(y, r.divisor, r.height);
        const auto* above = &good[std::size_t{row.low} * r.width];
        const auto* below = &good[std::size_t{row.high} * r.width];
        for (const auto& c : columns) {
            const auto p = glm::mix(glm::mix(above[c.low], above[c.high], c.share),
                glm::mix(below[c.low], below[c.high], c.share), row.share);
            out.pixels.push_back(p / (1.0f - p * exposure));
        }
    }
    return out;
}

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
