// Indirect light without a photon map: rays of a final gather that meet a diffuse surface go on from there, as paths
// do, and see its direct light and its caustics. Caustics alone come from photons, so that what has no caustics has no
// blur.
//
//     final_gather_ray -> eye_bounce ... -> follow_path -> direct light, caustics -> add_near_light
//         ^----------------------------------------------------|
#pragma once

#include <photongrid/render/final_gather.hpp>
#include <photongrid/render/follow_path.kernel.hpp>
#include <photongrid/render/shrinking_radii.hpp>

#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Adds the irradiance that path number `number` of rays_of_gather(settings) brings to the points where eye rays
/// ended, for the pixels of `pixels`, to `light`. `eye_ray`: number of the eye ray; `caustics`: map of caustic photons,
/// whose estimates have the radii of `radii`.
///
/// A path meets at most as many surfaces that end its rays as a photon may hit (map_settings::photon_depth).
template <backend B>
void add_path(B& device, const device_scene<B>& s, const map_buffers<B>& caustics, const pass_radii<B>& radii,
    const detail::eye_hits<B>& eye_ends, const render_settings& settings, uint eye_ray, uint number, launch pixels,
    buffer_of<B, glm::vec4>& light)
{
    constexpr uint whole_rays = 2; // that never end by chance: they bring most of the light
    const std::size_t n = pixels.elements;
    auto weights = device.template make<glm::vec4>(n), gathered = device.template make<glm::vec4>(n);
    device.template run<kernels::weight_one>(n, {}, reads(), writes(weights));
    device.template run<kernels::zero_vectors>(n, {}, reads(), writes(gathered));
    const uint first_pixel = eye_ends.first_pixel + pixels.first;
    std::optional<detail::eye_hits<B>> ends; // of the rays before
    for (uint nth = 0; nth + 2 <= settings.map.photon_depth; ++nth) {
        const auto of_ray = detail::settings_of_gather_ray(settings, s.layout, eye_ray, number, nth);
        auto hits = detail::gather_hits(
            device, s, ends ? *ends : eye_ends, ends ? 0 : pixels.first, of_ray, eye_ray, number, nth, launch(n, 0));
        device.template run<kernels::follow_path>(n,
            {.may_end = nth < whole_rays ? 0u : 1u,
                .number = number,
                .nth = nth,
                .first_pixel = first_pixel,
                .seed = of_ray.seed},
            reads(hits.throughputs), writes(hits.points, weights));
        if (detail::checked_count<kernels::is_near_end>(device, n, {}, reads(hits.points)) == 0)
            break;
        detail::light_gather_ends(device, s, caustics, radii, hits, weights, of_ray, eye_ray, number, gathered);
        ends.emplace(std::move(hits));
    }
    device.template run<kernels::add_light>(pixels, {.first = pixels.first}, reads(gathered), writes(light));
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
