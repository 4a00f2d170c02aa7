// The bands of rows in which a large picture is drawn, so that its size does not set the memory that a device needs.
#pragma once

#include <photongrid/scene/render_settings.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Rows of a picture that are drawn together.
struct row_band {
    std::uint32_t first = 0, rows = 0;

    bool operator==(const row_band&) const = default;
};

/// The side of the largest tiles in which estimates are interpolated (interpolated_estimates.hpp), pixels.
inline constexpr std::uint32_t largest_tile = 8;

/// The bands of a picture, from the top: as many rows of whole tiles each as output_settings::band has room for, at
/// least one. The picture must have at least one pixel.
inline std::vector<row_band> bands_of(const output_settings& o)
{
    const std::uint32_t most = std::max(1u, o.band / o.width / largest_tile) * largest_tile;
    std::vector<row_band> all;
    for (std::uint32_t first = 0; first < o.height; first += most)
        all.push_back({first, std::min(most, o.height - first)});
    return all;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
