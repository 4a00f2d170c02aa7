// A picture, in the two steps of figure 1: build_map when geometry or lights change, draw for every view.
//
//     scene -> trace_photons (2.1) -> sorted_map | routed_map (2.2) -> knn_search (2.3) -> image (2.4)
//
// progressive_render is both, step by step, for who watches (3.4).
#pragma once

#include <photongrid/progressive_render.hpp>

namespace photongrid {

/// Draws a view with a map that is there already (figure 1, right): no photon pass runs. Pixels that are NaN or
/// infinite are set to 0 and counted in stats.invalid_pixels.
/// \throws std::invalid_argument for a camera or settings that check() refuses, backend_error, render_cancelled.
/// \snippet snippets.cpp draw
template <backend B>
image draw(B& b, const built_map<B>& built, const camera& view, const render_settings& settings,
    const render_observer& observer, render_stats& stats)
{
    const std::vector<first_look> looks{{8, 16}, {4, 16}, {2, 16}, {1, 16}, {1, 4}};
    progressive_view<B> drawing(b, built, view, settings, stats,
        observer.intermediate ? looks : std::vector<first_look>{},
        observer.intermediate || observer.cancelled ? pass_size::small : pass_size::largest);
    std::uint64_t seen = 0;
    detail::run_to_end(drawing, observer, [&] {
        if (observer.progress)
            observer.progress("radiance_estimate", drawing.fraction());
        if (observer.intermediate && drawing.pictures() > seen && !drawing.finished()) {
            seen = drawing.pictures();
            observer.intermediate(drawing.picture());
        }
    });
    return drawing.picture();
}

/// Both steps at once, seen by the scene's own camera.
/// \throws what build_map and draw throw.
/// \snippet snippets.cpp render
template <backend B>
image render(
    B& b, const scene& s, const render_settings& settings, const render_observer& observer, render_stats& stats)
{
    const auto built = build_map(b, s, settings, observer, stats);
    return draw(b, built, s.camera, settings, observer, stats);
}

} // namespace photongrid
