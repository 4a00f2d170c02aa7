// The previews before a picture, as plain data computed from the settings and from the times measured so far. Larger
// pixels, a smaller k and fewer photons make a preview noisier, but not darker.
#pragma once

#include <photongrid/scene/scene.hpp>

#include <algorithm>
#include <limits>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// An intermediate picture with larger pixels or a smaller k.
struct preview {
    std::uint32_t divisor = 1;   ///< side of its pixels, in the picture's pixels
    std::uint32_t k_divisor = 1; ///< divisor of k; at least 8 photons are sought, or k if that is less

    bool operator==(const preview&) const = default;
};

/// Settings of previews. The picture does not depend on them.
struct preview_settings {
    bool enabled = true;   ///< false: no previews
    double target_ms = 40; ///< time for the first map, and for the first preview drawn with it
    /// Replace previews by running estimates (2.4) if the search is the paper's. On cpu the search then runs twice: by
    /// kernels to show, by SIMD for the result.
    bool running_estimates = false;
    /// One preview alone, so that there is a picture if drawing ends early: others take their time from its passes.
    bool only_first = false;
};

/// Measured costs; initially a guess between those of a GPU and of one CPU thread.
struct work_costs {
    double ms_per_photon = 2e-3;                                   ///< to trace it and build the map
    double ms_per_preview_pixel = 1e-2;                            ///< of the first preview
    double ms_per_pixel = std::numeric_limits<double>::infinity(); ///< of the picture
};

/// The number of photons for the first preview: fewer than the picture's if tracing all of them takes too long.
inline std::uint32_t preview_photons(const render_settings& s, const work_costs& costs, double target_ms)
{
    std::uint32_t divisor = 1;
    while (
        divisor < 64 && s.map.photons / divisor > 1024 && s.map.photons / divisor * costs.ms_per_photon > 2 * target_ms)
        divisor *= 2;
    return s.map.photons / divisor;
}

/// The previews drawn with a map of `map_photons` photons: first with pixels large enough for the target time, then
/// with smaller pixels, then with larger k. With a map of fewer photons than the picture's there is one preview.
/// `after_early_one`: such a preview has been shown.
inline std::vector<preview> preview_schedule(const render_settings& s, std::uint32_t map_photons, bool after_early_one,
    const work_costs& costs, double target_ms)
{
    const auto pixels = [&](std::uint32_t divisor) {
        return static_cast<double>((s.output.width + divisor - 1) / divisor)
            * ((s.output.height + divisor - 1) / divisor);
    };
    const bool early = map_photons < s.map.photons;
    if (!early && pixels(1) * costs.ms_per_pixel <= target_ms)
        return {}; // the picture is as fast as a preview should be
    std::uint32_t divisor = 1;
    while (std::min(s.output.width, s.output.height) / divisor >= 64 // smaller previews show too little
        && pixels(divisor) * costs.ms_per_preview_pixel > target_ms)
        divisor *= 2;
    std::uint32_t least = 1; // a preview is drawn in one band, so it must fit
    while (pixels(least) > s.output.band)
        least *= 2;
    divisor = std::max(divisor, least);
    if (early)
        return {{divisor, std::max(1u, 16 / std::max(1u, s.map.photons / map_photons))}};
    std::vector<preview> all;
    for (divisor = after_early_one ? std::max(1u, divisor / 2) : divisor; divisor > 1 && divisor >= least; divisor /= 2)
        all.push_back({divisor, 16});
    if (least > 1)
        return all;
    // In dark regions the growing search visits everything within the maximum radius, whatever k is, so a preview with
    // the picture's pixel size would take as long as the picture (3.1).
    const bool grows = s.estimate.search == search_kind::at_least_k;
    if (all.empty() || !grows)
        all.push_back({1, 16});
    if (s.estimate.k > 32 && !grows) // else k / 4 is no more than the 8 photons of the preview before
        all.push_back({1, 4});
    return all;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
