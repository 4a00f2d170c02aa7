// The reference renderer, against which errors of the photon map are measured. It runs on the CPU in double precision
// and shares no kernels. It is a path tracer with shadow rays, and a light tracer with bins for caustics, and for
// light on rough surfaces, that eye paths cannot find. docs/reference/reference_renderer.md has the conventions that it
// shares with the photon-map renderer. It uses threads: link Threads::Threads if the system needs that.
#pragma once

#include <photongrid/reference/path_tracer.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace reference {
    /// A place along an axis of a pixel, from 0 to 1 within it; `u`: a random number from 0 to 1.
    inline double place_in_pixel(pixel_filter filter, double u)
    {
        if (filter == pixel_filter::box)
            return u;
        return u < 0.5 ? std::sqrt(2 * u) - 0.5 : 1.5 - std::sqrt(2 - 2 * u);
    }
} // namespace reference

/// Renders a view without a photon map. The same scene and settings give the same bytes with any number of threads. The
/// result is unbiased except for the bins, which blur caustics over their size (stats.bin_size), and for the depth
/// limits.
/// \throws std::invalid_argument for a scene, camera or settings that check() rejects, render_cancelled.
/// \snippet snippets.cpp render_reference
inline reference_picture render_reference(
    const scene& given, const camera& view, const reference_settings& settings, const render_observer& observer = {})
{
    using clock = std::chrono::steady_clock;
    const auto seconds_since
        = [](clock::time_point start) { return std::chrono::duration<double>(clock::now() - start).count(); };
    check(given);
    scene s = given;
    part_walls(s, media_of(s));
    check(view);
    check(settings);
    reference_picture out;
    out.stats.threads = reference::threads_for(settings.threads);
    const reference::geometry shapes(s);

    const auto light_start = clock::now();
    const reference::caustic_bins caustics(s, shapes, settings, observer, out.stats);
    const reference::rough_bins on_rough(s, shapes, settings, observer, out.stats);
    out.stats.light_seconds = seconds_since(light_start);

    // Samples of a pixel that use the same bins are not independent; groups of samples with separate bins are.
    const bool has_bins = !caustics.empty() || !on_rough.empty();
    const std::uint32_t groups = has_bins ? reference::light_groups : settings.spp;
    const std::uint32_t per_group = (settings.spp + groups - 1) / groups;
    out.stats.spp = groups * per_group;

    const dvec3 forward = glm::normalize(view.look_at - view.position);
    const dvec3 right = glm::normalize(glm::cross(forward, view.up));
    const dvec3 up = glm::cross(right, forward);
    const double pixel = 2 * std::tan(glm::radians(0.5 * view.vertical_fov)) / settings.height;

    const std::size_t pixels = std::size_t{settings.width} * settings.height;
    out.mean = {settings.width, settings.height, std::vector<glm::vec3>(pixels, glm::vec3(0))};
    out.standard_error = out.mean;
    std::vector<std::uint64_t> invalid(settings.height, 0);
    const reference::path_tracer tracer(s, shapes, caustics, on_rough, settings);
    const auto eye_start = clock::now();
    reference::share_out(settings.height, out.stats.threads, "eye_paths", static_cast<double>(pixels), observer,
        [&](std::uint32_t y, reference::watch& w) {
            for (std::uint32_t x = 0; x < settings.width; ++x) {
                const std::size_t i = std::size_t{y} * settings.width + x;
                reference::random_stream random(settings.seed, 2, i);
                dvec3 mean(0), squares(0); // of the groups' means, by Welford's update
                for (std::uint32_t g = 0; g < groups; ++g) {
                    if (g % 64 == 0 && !w.goes_on(0))
                        return;
                    dvec3 sum(0);
                    for (std::uint32_t n = 0; n < per_group; ++n) {
                        const double dx = reference::place_in_pixel(settings.filter, random()),
                                     dy = reference::place_in_pixel(settings.filter, random());
                        const dvec3 d = forward + (x + dx - 0.5 * settings.width) * pixel * right
                            + (0.5 * settings.height - (y + dy)) * pixel * up;
                        const dvec3 sample = tracer.radiance(
                            {view.position, glm::normalize(d), reference::nothing}, random, has_bins ? g : 0);
                        if (detail::finite(sample))
                            sum += sample;
                        else
                            ++invalid[y];
                    }
                    const dvec3 group_mean = sum / static_cast<double>(per_group), before = group_mean - mean;
                    mean += before / (g + 1.0);
                    squares += before * (group_mean - mean);
                }
                out.mean.pixels[i] = glm::vec3(mean);
                out.standard_error.pixels[i] = glm::vec3(glm::sqrt(squares / (groups * (groups - 1.0))));
                if (!w.goes_on(1))
                    return;
            }
        });
    out.stats.eye_seconds = seconds_since(eye_start);
    for (const auto n : invalid)
        out.stats.invalid_samples += n;
    for (const auto& e : out.standard_error.pixels)
        out.stats.mean_standard_error += glm::dot(dvec3(e), dvec3(1.0 / 3.0)) / static_cast<double>(pixels);
    return out;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
