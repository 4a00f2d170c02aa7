// Figure 1 of the paper. A picture is the mean of output.passes passes, and a pass is
//
//     scene -> trace_photons -> build_map ----------------------------+
//     camera -> trace_eye -> direct_light -> irradiance (2.3) -> shade -> film
//
// Each stage is a step that is called until it is done, so that a render can stop between two calls (step_list.hpp).
// The program and the window run the same steps through progressive_render (3.4), which adds previews and resuming.
#pragma once

#include <photongrid/render/film.hpp>
#include <photongrid/render/passes.hpp>
#include <photongrid/render/picture_end.hpp>
#include <photongrid/render/scene_map.hpp>
#include <photongrid/render/step_list.hpp>
#include <photongrid/render/view_pass.hpp>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The steps to a map that only gives the first radii (shrinking_radii.hpp): photons are traced from the lights and
/// sorted or routed into a grid. `m` must outlive the steps.
template <backend B>
step_list radius_map_steps(map_building<B>& m)
{
    step_list steps;
    steps.add("trace_photons", [&m] { return m.trace_photons(); }); // 2.1
    steps.add("build_map", [&m] { return m.build_map(); });         // 2.2
    return steps;
}
/// The left side of figure 1, which runs again only if geometry, materials or lights change: the same, and the
/// irradiance at photons for a final gather.
template <backend B>
step_list map_steps(map_building<B>& m)
{
    auto steps = radius_map_steps(m);
    steps.add("build_map", [&m] { return m.estimate_at_photons(); });
    return steps;
}

/// The right side of figure 1, which runs for every view: traces eye rays, computes direct light and irradiance at
/// their hits, and adds both to the pixels. `v` must outlive the steps.
template <backend B>
step_list view_steps(view_pass<B>& v)
{
    step_list steps;
    const uint done = v.light().rays; // above 0 in a picture that was resumed
    steps.repeat(done, v.rays(), [&v](uint ray) {
        step_list stages;
        stages.add("trace_eye", [&v, ray] { return v.trace_eye(ray); });       // 2.4
        stages.add("direct_light", [&v, ray] { return v.direct_light(ray); }); // 2.4
        stages.add("gather", [&v, ray] { return v.gather(ray); });
        stages.add("irradiance", [&v, ray] { return v.irradiance(ray); }); // 2.3
        stages.add("shade", [&v, ray] { return v.shade(ray); });           // 2.4
        return stages;
    });
    return steps;
}

/// The steps of a pass over its bands of rows, without those above `rows_done`. `begin` is called with a band and
/// returns the steps of its view; `end` is called after them.
inline step_list band_steps(const output_settings& output, std::uint32_t rows_done,
    std::function<step_list(row_band)> begin, std::function<void()> end)
{
    step_list steps;
    const auto bands = bands_of(output);
    const auto first
        = std::find_if(bands.begin(), bands.end(), [&](const row_band& b) { return b.first >= rows_done; });
    steps.repeat(static_cast<uint>(first - bands.begin()), static_cast<uint>(bands.size()),
        [bands, begin = std::move(begin), end = std::move(end)](uint i) {
            step_list of_band;
            of_band.expand([begin, b = bands[i]] { return begin(b); });
            of_band.expand([end] {
                end();
                return step_list();
            });
            return of_band;
        });
    return steps;
}

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

/// The pixels of one pass over a view. Times and counts are added to `stats`.
/// \throws what draw throws.
template <backend B>
pass_pixels draw_pass(B& device, const built_map<B>& built, const camera& view, const render_settings& settings,
    const render_observer& observer, render_stats& stats, const pass_radii<B>& radii = {})
{
    check(settings);
    check(view);
    kept_samples<B> reusable; // samples of a preview that the next view takes over
    const bool shows_previews = static_cast<bool>(observer.intermediate);
    const auto size = shows_previews || observer.cancelled ? step_size::small : step_size::largest;
    std::uint64_t invalid = 0;
    if (shows_previews)
        for (const auto& p :
            preview_schedule(settings, settings.map.photons, false, {}, preview_settings{}.target_ms)) {
            view_pass<B> preview(device, built, view, settings, {p, size}, reusable, stats);
            run(view_steps(preview), observer, [](std::string_view) {});
            observer.intermediate(preview.mean_of_samples(invalid));
        }

    const bool shows_estimates = shows_previews && bands_of(settings.output).size() == 1; // of a band: some rows only
    const double pixels = static_cast<double>(settings.output.width) * settings.output.height;
    pass_pixels light;
    std::optional<view_pass<B>> band;
    const auto begin = [&](row_band rows) {
        band.emplace(
            device, built, view, settings, view_pass_settings{{}, size, shows_estimates, false, rows}, reusable, stats);
        band->use_radii(radii);
        return view_steps(*band);
    };
    const auto report = [&] {
        const double of_band = band->fraction() * static_cast<double>(band->light().raster.size());
        if (observer.progress)
            observer.progress("radiance_estimate", (static_cast<double>(light.pixels.size()) + of_band) / pixels);
    };
    const auto end = [&] {
        report(); // here, since `end` runs before the callback below, and before pixels are read back
        finish_band(device, *band, light, stats);
        band.reset();
    };
    uint shown = 0; // running estimates (2.4)
    run(band_steps(settings.output, 0, begin, end), observer, [&](std::string_view) {
        if (!band)
            return;
        report();
        if (band->grown() > shown)
            observer.intermediate(band->running_estimate(invalid));
        shown = band->grown();
    });
    finish_pass(device, built, stats);
    return light;
}

/// Builds the map that gives the first radii of all passes.
/// \throws what build_map throws.
template <backend B>
built_map<B> build_radius_map(B& device, std::shared_ptr<world<B>> of, const render_settings& settings,
    const render_observer& observer, render_stats& stats)
{
    map_building<B> building(device, std::move(of), settings_of_radius_map(settings, device.caps()));
    run(radius_map_steps(building), observer, [](std::string_view) {});
    auto built = building.take();
    detail::add_map(stats, built.stats);
    return built;
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
    sum.add(0, draw_pass(device, built, view, settings, observer, out.stats));
    finish_picture(sum, out);
    return out;
}

/// Draws a picture with the scene's own camera: the mean of output.passes passes, each with its own photons, eye rays
/// and shadow rays, or of as many as a stop rule asks for (picture_end.hpp); at least one is whole.
/// \throws what build_map and draw throw.
/// \snippet snippets.cpp render
template <backend B>
[[nodiscard]] rendered render(
    B& device, const scene& s, const render_settings& settings, const render_observer& observer = {})
{
    check(settings);
    rendered out;
    film sum;
    picture_judge judge(settings.output);
    work_clock clock;
    clock.go_on();
    auto every = settings;
    every.output.passes = settings.output.passes_at_most();
    const auto shared = prepare(device, s, observer);
    out.stats.prepare_scene = shared->prepared;
    sum = film_for(s, shared->scene.layout, settings);
    std::optional<built_map<B>> radii;
    if (has_shrinking_radii(every))
        radii = build_radius_map(device, shared, every, observer, out.stats);
    for (uint pass = 0; !judge.ended(); ++pass) {
        const auto own = settings_of_pass(every, pass);
        const auto map = build_map(device, shared, own, observer);
        detail::add_map(out.stats, map.stats);
        const auto of_pass
            = radii ? radii_of_pass(*radii, settings_of_radius_map(every, device.caps()), pass) : pass_radii<B>{};
        sum.add(pass, draw_pass(device, map, s.camera, own, observer, out.stats, of_pass));
        judge.after_pass(sum, clock.seconds(), out.stats);
        judge.before_pass(sum, clock.seconds());
        if (observer.intermediate && !judge.ended())
            observer.intermediate(sum.picture().picture);
    }
    out.stats.end = judge.result();
    finish_picture(sum, out);
    return out;
}
/// The same with the scene's own settings.
template <backend B>
[[nodiscard]] rendered render(B& device, const scene& s)
{
    return render(device, s, s.render);
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
