// Indirect light without a photon map: rays of a final gather that meet a diffuse surface go on from there, as paths
// do, and see its direct light and its caustics. Caustics alone come from photons, so that what has no caustics has no
// blur.
//
//     final_gather_ray -> eye_bounce ... -> follow_path -> direct light, caustics -> add_near_light
//         ^----------------------------------------------------|
#pragma once

#include <photongrid/render/final_gather.hpp>
#include <photongrid/render/follow_path.kernel.hpp>

#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Adds the irradiance that one of rays_of_gather(settings) paths, which begins with `ray`, brings to the points where
/// eye rays ended, to `light`.
///
/// A path meets at most as many surfaces that end its rays as a photon may hit (map_settings::photon_depth).
template <backend B>
void add_path(B& device, const device_scene<B>& s, const near_light<B>& near, const detail::eye_hits<B>& eye_ends,
    detail::gather_ray ray, buffer_of<B, glm::vec4>& light)
{
    constexpr uint whole_rays = 2; // that never end by chance: they bring most of the light
    const launch pixels = ray.from.pixels;
    const std::size_t n = pixels.elements;
    gathering<B> sum(device, n);
    const uint first_pixel = eye_ends.first_pixel + pixels.first;
    std::optional<detail::eye_hits<B>> ends; // of the rays before
    for (ray.nth = 0; ray.nth + 2 <= ray.from.settings.map.photon_depth; ++ray.nth) {
        const auto settings = detail::settings_of(ray, s.layout);
        auto hits = detail::gather_hits(device, s, ends ? *ends : eye_ends, ends ? 0 : pixels.first, ray, settings);
        device.template run<kernels::follow_path>(n,
            {.may_end = ray.nth < whole_rays ? 0u : 1u,
                .number = ray.number,
                .nth = ray.nth,
                .first_pixel = first_pixel,
                .seed = settings.seed},
            reads(hits.throughputs), writes(hits.points, sum.weights));
        if (detail::checked_count<kernels::is_near_end>(device, n, {}, reads(hits.points)) == 0)
            break;
        detail::light_gather_ends(device, s, near, hits, {{settings, ray.from.ray, pixels}, ray.number, ray.nth}, sum);
        ends.emplace(std::move(hits));
    }
    device.template run<kernels::add_light>(pixels, {.first = pixels.first}, reads(sum.gathered), writes(light));
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
