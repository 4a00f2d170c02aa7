// The colours and numbers of textures, for the reference renderer.
#pragma once

#include <photongrid/scene/texture.hpp>

#include <algorithm>
#include <cmath>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// The channels of a texture at texture coordinates, interpolated between the four nearest texels; 1 without a map.
inline glm::dvec4 channels_at(const texture_use& t, const glm::dvec2& coordinates)
{
    if (!t.map)
        return glm::dvec4(1);
    const auto& m = *t.map;
    const auto texel = [&](double column, double row) {
        const auto place = [&](double at, std::uint32_t size) {
            const double inside
                = t.wrap == texture_wrap::repeat ? at - std::floor(at / size) * size : std::clamp(at, 0.0, size - 1.0);
            return std::min(static_cast<std::size_t>(inside), std::size_t{size} - 1);
        };
        return glm::dvec4(m.texels[place(row, m.height) * m.width + place(column, m.width)]) / 65535.0;
    };
    const glm::dvec2 moved = t.scale * coordinates + t.offset;
    const double u = moved.x * m.width - 0.5, v = (1 - moved.y) * m.height - 0.5;
    const double left = std::floor(u), top = std::floor(v);
    return glm::mix(glm::mix(texel(left, top), texel(left + 1, top), u - left),
        glm::mix(texel(left, top + 1), texel(left + 1, top + 1), u - left), v - top);
}

/// Linear rgb.
inline dvec3 color_at(const texture_use& t, const glm::dvec2& coordinates)
{
    return dvec3(channels_at(t, coordinates));
}

/// The number in its channel.
inline double number_at(const texture_use& t, const glm::dvec2& coordinates)
{
    return channels_at(t, coordinates)[static_cast<int>(t.channel)];
}

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
