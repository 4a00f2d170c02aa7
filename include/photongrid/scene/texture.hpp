// Pictures on surfaces.
#pragma once

#include <photongrid/scene/check.hpp>

#include <glm/ext/vector_uint4_sized.hpp>
#include <glm/vec2.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A picture that is laid on surfaces. Its first row is at the top, v = 1.
struct texture {
    std::uint32_t width = 1, height = 1;
    /// Width x height, row by row; 65535 is 1. Of a colour: linear rgb; else channels as their file has them, the last
    /// one opacity.
    std::vector<glm::u16vec4> texels{glm::u16vec4(65535)};

    bool operator==(const texture&) const = default;
};

/// The most texels of all textures of a scene.
inline constexpr std::size_t max_texels = std::size_t{1} << 28;

/// What is beyond the edges of a texture: the same again, or its outermost texels.
enum class texture_wrap { repeat, clamp };

/// The channel of a texture that holds one number.
enum class texture_channel { red, green, blue, alpha };

/// Their names in scene files.
inline constexpr std::array texture_channel_names{"red", "green", "blue", "alpha"};

/// A texture as a material uses it. A point of a surface has the texture's colour, or the number in one channel, at
/// scale * (texture coordinates) + offset, interpolated between the four nearest texels.
struct texture_use {
    std::string file;                               ///< that it was read from; empty: none
    std::shared_ptr<const texture> map;             ///< null: none; it must not change any more
    texture_wrap wrap = texture_wrap::repeat;       ///< beyond its edges
    glm::dvec2 scale{1};                            ///< of coordinates
    glm::dvec2 offset{0};                           ///< added to them then
    texture_channel channel = texture_channel::red; ///< where it is a number and not a colour

    bool operator==(const texture_use& o) const
    {
        return file == o.file && wrap == o.wrap && scale == o.scale && offset == o.offset && channel == o.channel
            && (map == o.map || (map && o.map && *map == *o.map));
    }
};

/// \throws std::invalid_argument for a size that is 0, or not that of `texels`, or above the limit; for a scale or an
///         offset that is not finite or above 10^6; or for a channel that is none.
inline void check(const texture_use& t)
{
    if (!t.map)
        return;
    detail::require(t.channel <= texture_channel::alpha, "texture: channel: must be one of the enumerators");
    const std::size_t texels = std::size_t{t.map->width} * t.map->height;
    detail::require(texels > 0 && t.map->texels.size() == texels, "texture: must have width x height texels");
    detail::require(texels <= max_texels && t.map->width <= 65536 && t.map->height <= 65536,
        "texture: is too large; at most 65536 texels a side and 2^28 in all");
    for (const double v : {t.scale.x, t.scale.y, t.offset.x, t.offset.y})
        detail::require(std::abs(v) <= 1e6, "texture: scale and offset must be from -10^6 to 10^6");
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
