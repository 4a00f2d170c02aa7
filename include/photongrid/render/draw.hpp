// One map, and one pass over a view from it, for hosts that keep their maps.
#pragma once

#include <photongrid/render/film.hpp>
#include <photongrid/render/passes.hpp>
#include <photongrid/render/stages.hpp>

#include <memory>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Traces photons and builds the map for a pass. A scene without indirect light has an empty map.
/// \throws std::invalid_argument for settings that check() rejects, backend_error, render_cancelled.
template <backend B>
built_map<B> build_map(
    B& device, std::shared_ptr<world<B>> of, const render_settings& settings, const render_observer& observer = {})
{
    map_building<B> map(device, std::move(of), settings);
    run(map_steps(map), observer, [&](std::string_view stage) {
        if (observer.progress)
            observer.progress(stage, map.fraction());
    });
    return map.take();
}
/// The same in a world of its own.
/// \throws what prepare() throws.
/// \snippet snippets.cpp build_map
template <backend B>
built_map<B> build_map(B& device, const scene& s, const render_settings& settings, const render_observer& observer = {})
{
    auto of = prepare(device, s, observer);
    auto built = build_map(device, std::move(of), settings, observer);
    built.stats.prepare_scene = built.world->prepared;
    return built;
}

/// What a pass has besides its map, view and settings.
template <backend B>
struct pass_options {
    render_observer observer{};
    pass_radii<B> radii{}; ///< empty: those of the map
};

/// The pixels of one pass over a view. Times and counts are added to `stats`.
/// \throws what draw throws.
template <backend B>
pass_pixels draw_pass(B& device, const built_map<B>& built, const camera& view, const render_settings& settings,
    render_stats& stats, const pass_options<B>& options = {})
{
    const auto& observer = options.observer;
    check(settings);
    pass_pixels light;
    const double pixels = static_cast<double>(settings.output.width) * settings.output.height;
    for (const auto& rows : bands_of(settings.output)) {
        const view_pass_settings how{.size = observer.cancelled ? step_size::small : step_size::largest, .band = rows};
        view_pass<B> band(device, built, view, settings, how, stats);
        band.use_radii(options.radii);
        run(view_steps(band), observer, [&](std::string_view) {
            const double of_band = band.fraction() * static_cast<double>(band.light().raster.size());
            if (observer.progress)
                observer.progress("radiance_estimate", (static_cast<double>(light.pixels.size()) + of_band) / pixels);
        });
        finish_band(device, band, light, stats);
    }
    finish_pass(device, built, stats);
    return light;
}

/// Draws one pass over a view, from an existing map: no photons are traced, and radii are those of the map. Pixels that
/// are NaN or infinite are set to 0 and counted in stats.invalid_pixels. The statistics include those of the map.
/// \throws std::invalid_argument for a camera or settings that check() rejects, backend_error, render_cancelled.
/// \snippet snippets.cpp draw
template <backend B>
[[nodiscard]] rendered draw(B& device, const built_map<B>& built, const camera& view, const render_settings& settings,
    const render_observer& observer = {})
{
    rendered out{{}, built.stats};
    film sum(settings.output.width, settings.output.height, 1, settings.output.aov, tells_bias(settings));
    sum.add(0, draw_pass(device, built, view, settings, out.stats, {.observer = observer}));
    auto developed = sum.picture();
    out.picture = std::move(developed.picture);
    out.stats.invalid_pixels = developed.invalid_pixels;
    return out;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
