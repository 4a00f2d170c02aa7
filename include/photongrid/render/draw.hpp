// One map, and one pass over a view from it, for hosts that keep their maps.
#pragma once

#include <photongrid/render/film.hpp>
#include <photongrid/render/pass_drawing.hpp>

#include <memory>
#include <optional>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Traces photons and builds the map for a pass. A scene without indirect light has an empty map.
/// \throws std::invalid_argument for settings that check() rejects, backend_error, render_cancelled.
template <backend B>
built_map<B> build_map(B& device, std::shared_ptr<world<B>> of, const render_settings& settings,
    const render_observer& observer = {}, map_use use = map_use::light)
{
    map_building<B> map(device, std::move(of), settings, use);
    while (!map.finished()) {
        const auto stage = map.stage();
        detail::stop_if_cancelled(observer);
        map.advance();
        if (observer.progress)
            observer.progress(stage, map.fraction());
    }
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
    const auto size = observer.cancelled ? step_size::small : step_size::largest;
    pass_drawing<B> pass(device, built, view, settings, {.size = size}, stats);
    pass.use_radii(options.radii);
    do {
        detail::stop_if_cancelled(observer);
        pass.advance();
        if (observer.progress)
            observer.progress("radiance_estimate", pass.fraction());
    } while (!pass.finished());
    return pass.take();
}

/// The light of pass `number` of a picture, with a map of its own: a function of these arguments alone. A film of all
/// passes is the picture, whoever draws them, in whatever order.
/// \throws what build_map and draw throw.
/// \snippet snippets.cpp draw_pass
template <backend B>
[[nodiscard]] pass_pixels draw_pass(
    B& device, std::shared_ptr<world<B>> of, const camera& view, const render_settings& settings, uint number)
{
    std::optional<built_map<B>> first; // for the radii of all passes
    pass_options<B> options;
    if (has_shrinking_radii(settings)) {
        const auto with = settings_of_radius_map(settings, device.caps());
        first.emplace(build_map(device, of, with, {}, map_use::first_radii));
        options.radii = radii_of_pass(*first, with, number);
    }
    const auto with = settings_of_pass(settings, number);
    render_stats stats;
    return draw_pass(device, build_map(device, std::move(of), with), view, with, stats, options);
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
    film sum(settings.output.width, settings.output.height, 1, settings.output.aov, reports_bias(settings),
        settings.estimate.filter);
    sum.add(0, draw_pass(device, built, view, settings, out.stats, {.observer = observer}));
    auto developed = sum.picture();
    out.picture = std::move(developed.picture);
    out.stats.invalid_pixels = developed.invalid_pixels;
    return out;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
