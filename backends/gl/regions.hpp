// The rectangles of texels that launches, tiles and transfers cover.
#pragma once

#include <photongrid/backends/gl/layout.hpp>

#include <algorithm>
#include <bit>
#include <vector>

namespace photongrid::gl {

/// A rectangle of texels.
struct region {
    GLint x, y;
    GLsizei width, height;
};

/// Calls f(first element, row, width, rows) for the full rows of a buffer and for its last, shorter one.
template <class F>
void for_blocks(std::size_t n, F&& f)
{
    const std::size_t full = n / row_width;
    const std::size_t rest = n % row_width;
    if (full > 0)
        f(std::size_t{0}, 0, static_cast<GLsizei>(row_width), static_cast<GLsizei>(full));
    if (rest > 0)
        f(full * row_width, static_cast<GLint>(full), static_cast<GLsizei>(rest), 1);
}

/// The texels of a launch: part of one row, or whole rows, of which the program discards texels outside the launch.
inline region region_of(const launch& l)
{
    const uint last = l.first + (l.elements - 1);
    const uint row = l.first / row_width, end = last / row_width + 1;
    if (end - row == 1)
        return {static_cast<GLint>(l.first % row_width), static_cast<GLint>(row), static_cast<GLsizei>(l.elements), 1};
    return {0, static_cast<GLint>(row), static_cast<GLsizei>(row_width), static_cast<GLsizei>(end - row)};
}

/// Tiles of about tile x tile elements, wider if there are few rows.
inline std::vector<region> tiles_of(const launch& l, uint tile)
{
    const region all = region_of(l);
    const auto high = std::min(static_cast<GLsizei>(tile), all.height);
    const auto wide = static_cast<GLsizei>(std::bit_ceil(tile * tile / static_cast<uint>(high)));
    std::vector<region> tiles;
    for (GLint y = all.y; y < all.y + all.height; y += high)
        for (GLint x = all.x; x < all.x + all.width; x += wide)
            tiles.push_back({x, y, std::min(wide, all.x + all.width - x), std::min(high, all.y + all.height - y)});
    return tiles;
}

} // namespace photongrid::gl
