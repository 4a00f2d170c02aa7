// The stochastic ray tracer (section 2.4): eye rays through mirrors and glass, and direct light where they end.
#pragma once

#include <photongrid/core/zero_vectors.kernel.hpp>
#include <photongrid/trace/add_unblocked.kernel.hpp>
#include <photongrid/trace/device_scene.hpp>
#include <photongrid/trace/direct_light.kernel.hpp>
#include <photongrid/trace/eye_bounce.kernel.hpp>
#include <photongrid/trace/eye_ray.kernel.hpp>
#include <photongrid/trace/eye_ray_to_search.kernel.hpp>
#include <photongrid/trace/mesh_search.hpp>
#include <photongrid/trace/rough_points.kernel.hpp>
#include <photongrid/trace/scatter_rough.kernel.hpp>
#include <photongrid/trace/shadow_ray.kernel.hpp>
#include <photongrid/trace/shadow_through.kernel.hpp>

#include <bit>
#include <optional>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// The pixels of a picture, of some of its rows, or of a preview, whose pixels are squares of several.
struct raster {
    uint width = 0, height = 0;
    uint divisor = 1;   ///< side of a pixel, in pixels of the picture
    uint first_row = 0; ///< of the picture

    std::size_t size() const { return std::size_t{width} * height; }
    uint first_pixel() const { return first_row * width; }
};

/// Eye rays and their hits, one element per pixel.
template <backend B>
struct eye_hits {
    buffer_of<B, glm::vec4> points, directions, throughputs, surfaces, emissions;
    uint first_pixel = 0; ///< pixel of element 0; random numbers depend on the pixel

    eye_hits(B& device, std::size_t n, uint first = 0)
        : points(device.template make<glm::vec4>(n)), directions(device.template make<glm::vec4>(n)),
          throughputs(device.template make<glm::vec4>(n)), surfaces(device.template make<glm::vec4>(n)),
          emissions(device.template make<glm::vec4>(n)), first_pixel(first)
    {
    }
};

/// The picture of `s` in squares of divisor x divisor pixels. Those at the right and lower edges may extend beyond it.
inline raster raster_of(const render_settings& s, uint divisor)
{
    return {(s.output.width + divisor - 1) / divisor, (s.output.height + divisor - 1) / divisor, divisor};
}

/// The most nearly square grid of strata for a number of samples: columns and rows, with columns >= rows.
inline glm::uvec2 strata_of(uint samples)
{
    uint rows = 1;
    for (uint r = 2; r * r <= samples; ++r)
        if (samples % r == 0)
            rows = r;
    return {samples / rows, rows};
}

/// How many times eye rays split: at glass, coats, rough surfaces, mixtures and what is clear in part
/// (eye_bounce.glsl). Each combination of branches is a pass over the picture.
inline uint splits_of(const scene_layout& layout)
{
    if ((layout.features & has_rough) != 0)
        return 3;
    return (layout.features & (has_glass | has_coats | has_mixtures | has_clear)) != 0 ? 2u : 0u;
}

/// Where an eye ray is in the sequences of its pixel's random numbers, which go on from pass to pass.
struct ray_place {
    uint branch = 0;
    uint nth = 0;  ///< of the pixel's eye rays of that branch, in all passes
    uint seed = 0; ///< of the sequences: the picture's
};

/// `ray` is sample x branches + branch.
inline ray_place place_of(const render_settings& s, uint ray, uint splits)
{
    return {ray & ((1u << splits) - 1u), s.pass.number * s.view.spp + (ray >> splits), s.seed ^ s.pass.seed_change};
}

/// The same eye ray of some pixels.
struct ray_of_pixels {
    const render_settings& settings;
    uint ray; ///< sample x branches + branch
    launch pixels;
};

/// The camera as eye_ray.glsl reads it. `ray` is sample x branches + branch.
inline kernels::eye_ray::Params eye_params(
    const camera& c, const dvec3& center, const render_settings& s, const raster& r, uint ray, uint splits = 0)
{
    check(c);
    const auto [forward, right, up] = camera_axes(c);
    const double height = 2 * std::tan(glm::radians(c.vertical_fov) / 2);
    const double width = height * s.output.width / s.output.height;
    const auto narrow = [](const dvec3& v) { return glm::vec4(glm::vec3(v), 0.0f); };
    const auto place = place_of(s, ray, splits);
    const bool middle = s.view.spp == 1 && s.output.passes <= 1;
    // The sequence itself gives each stratum of a power of two a point.
    const bool stratified = !std::has_single_bit(s.view.spp);
    return {.position = narrow(c.position - center),
        .corner = narrow(forward - 0.5 * width * right + 0.5 * height * up),
        .right = narrow(right * (width / s.output.width * r.divisor)),
        .down = narrow(-up * (height / s.output.height * r.divisor)),
        .strata = middle ? glm::uvec2(0)
            : stratified ? strata_of(s.view.spp)
                         : glm::uvec2(1),
        .width = r.width,
        .stratum = stratified ? ray >> splits : 0u,
        .nth = stratified ? s.pass.number : place.nth,
        .branch = place.branch,
        .seed = place.seed,
        .first_pixel = r.first_pixel(),
        .tent = s.view.filter == pixel_filter::tent ? 1u : 0u};
}

/// One sample of the light at each of some points: see the Params of shadow_ray.glsl.
struct light_sampling {
    glm::uvec2 strata{1};
    uint light = 0;
    uint sample_id = 0;
    uint seed = 0;
    uint choice = 0;
    uint choices = 0;
    uint sky = 0;
};

/// Points that light falls on.
template <backend B>
struct lit_points {
    const buffer_of<B, glm::vec4>&points, &surfaces;    ///< as shadow_ray.glsl reads them
    uint first = 0;                                     ///< element of the first point
    uint first_pixel = 0;                               ///< pixel of element 0
    uint whole = 1;                                     ///< see shadow_ray.glsl
    const buffer_of<B, glm::vec4>* sky_guide = nullptr; ///< null: there is none
};

/// Whether each sample chooses one of many lights.
inline bool samples_choose_lights(const scene_layout& layout)
{
    return layout.table(kernels::LIGHT_TABLE).count > most_lights_sampled_each;
}

/// The samples of direct light at a point: `light_samples` of each light with a size, one of each other light; or, of
/// many lights, samples that choose one. `sky`: see shadow_ray.glsl.
inline std::vector<light_sampling> light_samples_of(
    const scene_layout& layout, const render_settings& settings, uint seed, uint sky)
{
    std::vector<light_sampling> all;
    const auto lights = layout.table(kernels::LIGHT_TABLE);
    const uint samples = settings.view.light_samples;
    if (samples_choose_lights(layout)) {
        // Each sample is the only one of its light, so it may be anywhere on it.
        for (uint choice = 0; choice < samples; ++choice)
            all.push_back(
                {.seed = seed ^ (choice + 1) * 0x9E3779B1u, .choice = choice, .choices = samples, .sky = sky});
        return all;
    }
    for (uint number = 0; number < lights.count; ++number) {
        const bool differ = layout.records[lights.first + lights.stride * number].w != kernels::SAMPLED_ONCE;
        const uint of_this = differ ? samples : 1u;
        for (uint sample = 0; sample < of_this; ++sample)
            all.push_back(
                {.strata = strata_of(of_this), .light = number, .sample_id = sample, .seed = seed, .sky = sky});
    }
    return all;
}

/// Attenuates shadow rays by the opacity of the meshes that they cross.
template <backend B>
void attenuate(
    B& device, const device_scene<B>& s, mesh_rays<B>& rays, mesh_hits<B>& hits, buffer_of<B, glm::vec4>& arriving)
{
    for (bool finished = false; !finished;) {
        rays.find(device, s, hits);
        finished = device
                       .template run_until_done<kernels::shadow_through>({arriving.size(), 0u, s.layout.features}, {},
                           reads(s.records, rays.directions, hits.places, hits.normals, hits.shadings, hits.colors),
                           writes(rays.origins, arriving), 1u)
                       .finished;
    }
}

/// Takes samples of direct light at some points. Calls change(directions of the shadow rays, what arrives if nothing
/// blocks them) for each sample, and adds what then arrives, where no mesh blocks it, to `light`.
template <backend B, class Change>
void add_light_samples(B& device, const device_scene<B>& s, const std::vector<light_sampling>& samples,
    const ray_of_pixels& of, const lit_points<B>& lit, buffer_of<B, glm::vec4>& light, Change change)
{
    const launch pixels = of.pixels;
    mesh_rays<B> rays(device, pixels.elements);
    auto arriving = device.template make<glm::vec4>(pixels.elements);
    auto found = device.template make<glm::uvec4>(1);
    const bool through = (s.layout.features & has_clear) != 0;
    std::optional<mesh_hits<B>> met;
    if (through)
        met.emplace(device, s, pixels.elements);
    const auto place = place_of(of.settings, of.ray, splits_of(s.layout));
    for (const auto& how : samples) {
        device.template run<kernels::shadow_ray>({pixels.elements, 0u, s.layout.features},
            {.strata = how.strata,
                .light = how.light,
                .sample_id = how.sample_id,
                .first = lit.first,
                .branch = place.branch,
                .nth = place.nth,
                .seed = how.seed,
                .first_pixel = lit.first_pixel,
                .choice = how.choice,
                .choices = how.choices,
                .whole = lit.whole,
                .sky = how.sky},
            reads(s.records, lit.points, lit.surfaces, s.meshes->faces, s.meshes->planes, s.meshes->vertices,
                s.meshes->shares, s.environment->texels, s.environment->shares,
                lit.sky_guide != nullptr ? *lit.sky_guide : s.records),
            writes(rays.origins, rays.directions, arriving));
        change(rays.directions, arriving);
        if (through)
            attenuate(device, s, rays, *met, arriving);
        else if (s.has_meshes())
            found = rays.search(device, s, hit_kind::any);
        // Attenuated rays were tested against meshes above.
        const uint features = s.layout.features & ~(through ? uint{has_meshes} : 0u);
        device.template run<kernels::add_unblocked>(
            {pixels.elements, pixels.first, features}, {.first = pixels.first}, reads(arriving, found), writes(light));
    }
}
/// Takes those that the settings ask for.
template <backend B, class Change>
void add_light_samples(B& device, const device_scene<B>& s, const ray_of_pixels& of, const lit_points<B>& lit,
    buffer_of<B, glm::vec4>& light, Change change)
{
    const uint seed = place_of(of.settings, of.ray, splits_of(s.layout)).seed, sky = lit.sky_guide != nullptr ? 1 : 0;
    add_light_samples(device, s, light_samples_of(s.layout, of.settings, seed, sky), of, lit, light, change);
}

/// Adds direct light to the emissions of the eye rays that ended on rough surfaces.
template <backend B>
void light_rough_surfaces(B& device, const device_scene<B>& s, const ray_of_pixels& of, eye_hits<B>& hits)
{
    const launch pixels = of.pixels;
    auto points = device.template make<glm::vec4>(pixels.elements);
    auto surfaces = device.template make<glm::vec4>(pixels.elements);
    const auto ends = reads(s.records, hits.points, hits.directions, hits.throughputs, hits.surfaces, hits.emissions);
    for (uint behind = 0; behind < ((s.layout.features & has_glass) != 0 ? 2u : 1u); ++behind) {
        device.template run<kernels::rough_points>({pixels.elements, 0u, s.layout.features},
            {.first = pixels.first, .behind = behind}, ends, writes(points, surfaces));
        const lit_points<B> lit{points, surfaces, 0, hits.first_pixel + pixels.first, 0};
        add_light_samples(device, s, of, lit, hits.emissions, [&](const auto& ways, auto& arriving) {
            device.template run<kernels::scatter_rough>({pixels.elements, 0u, s.layout.features},
                {.first = pixels.first, .only_without_size = samples_choose_lights(s.layout) ? 1u : 0u},
                reads(s.records, hits.points, hits.directions, hits.throughputs, hits.surfaces, hits.emissions, ways),
                writes(arriving));
        });
    }
}

/// How rays are traced to their ends: see the Params of eye_bounce.glsl.
struct path_choices {
    uint branch = 0;
    uint splits = 0;
    uint depth = 0;
    float light_samples = 0;
    uint nth = 0;
    uint seed = 0;
};

/// Traces rays that eye_ray.glsl or final_gather_ray.glsl started to their ends.
template <backend B>
void trace_to_ends(B& device, const device_scene<B>& s, launch pixels, const path_choices& how, eye_hits<B>& hits,
    buffer_of<B, uint>& branches)
{
    mesh_hits<B> on_meshes(device, s, pixels.elements);
    mesh_rays<B> rays(device, s.has_meshes() ? pixels.elements : 0);
    for (bool finished = false; !finished;) {
        if (s.has_meshes()) {
            device.template run<kernels::eye_ray_to_search>(pixels.elements, {.first = pixels.first},
                reads(hits.points, hits.directions), writes(rays.origins, rays.directions));
            rays.find(device, s, on_meshes);
        }
        finished
            = device
                  .template run_until_done<kernels::eye_bounce>({pixels.elements, pixels.first, s.layout.features},
                      {.branch = how.branch,
                          .splits = how.splits,
                          .depth = how.depth,
                          .light_samples = how.light_samples,
                          .nth = how.nth,
                          .seed = how.seed,
                          .first_pixel = hits.first_pixel,
                          .first = pixels.first},
                      reads(s.records, on_meshes.places, on_meshes.normals, on_meshes.shadings, s.environment->texels,
                          on_meshes.colors),
                      writes(hits.points, hits.directions, hits.throughputs, hits.surfaces, hits.emissions, branches),
                      s.has_meshes() ? 1u : all_passes)
                  .finished;
    }
}

/// What eye rays look through.
struct eye_view {
    const camera& from;
    const raster& pixels;
};

/// Traces eye rays to their ends. Bit b of `branches` is set for the pixels for which branch b must be traced; rays of
/// other pixels end at once. Branch 0 sets its own bit, and a ray that splits sets that of its other branch, so the
/// branches of a sample must be traced in order.
template <backend B>
void trace_eye_rays(B& device, const device_scene<B>& s, const eye_view& view, const ray_of_pixels& of,
    eye_hits<B>& hits, buffer_of<B, uint>& branches)
{
    const auto& [settings, ray, pixels] = of;
    const auto& layout = s.layout;
    const uint splits = splits_of(layout);
    const auto place = place_of(settings, ray, splits);
    const uint sampled_at_rough = samples_choose_lights(layout) ? 0 : settings.view.light_samples;
    auto from = eye_params(view.from, layout.center, settings, view.pixels, ray, splits);
    from.position.w = static_cast<float>(layout.media.at(view.from.position));
    device.template run<kernels::eye_ray>(pixels, from, reads(),
        writes(hits.points, hits.directions, hits.throughputs, hits.surfaces, hits.emissions, branches));
    trace_to_ends(device, s, pixels,
        {.branch = place.branch,
            .splits = splits,
            .depth = settings.view.depth,
            .light_samples = static_cast<float>(sampled_at_rough),
            .nth = place.nth,
            .seed = place.seed},
        hits, branches);
    if ((layout.features & has_rough) != 0)
        light_rough_surfaces(device, s, of, hits);
}

/// Computes the irradiance of direct light at the hits of eye rays into `light`, with a bounded number of shadow rays
/// per pass. `sky_guide`: of these hits (sky_guide.hpp), or null.
template <backend B>
void direct_light(B& device, const device_scene<B>& s, const ray_of_pixels& of, const eye_hits<B>& hits,
    buffer_of<B, glm::vec4>& light, const buffer_of<B, glm::vec4>* sky_guide = nullptr)
{
    const auto& [settings, ray, pixels] = of;
    device.template run<kernels::zero_vectors>(pixels, {}, reads(), writes(light));
    // Features that direct_light.glsl does not handle.
    constexpr uint others
        = has_meshes | has_coats | has_media | (all_light_switches & ~(uint{has_point_lights} | uint{has_area_lights}));
    // A part of a lamp that is taken whole is seen whole or not at all: where something covers a part of it, the mean
    // of many passes is not exact.
    const bool takes_whole = settings.estimate.indirect != indirect_kind::paths && (s.layout.features & has_media) == 0;
    if ((s.layout.features & others) != 0 || samples_choose_lights(s.layout) || !takes_whole) {
        const lit_points<B> lit{
            hits.points, hits.surfaces, pixels.first, hits.first_pixel, takes_whole ? 1u : 0u, sky_guide};
        add_light_samples(device, s, of, lit, light, [](const auto&, auto&) {});
        return;
    }
    const uint samples = (s.layout.features & has_area_lights) != 0 ? settings.view.light_samples : 1u;
    const auto place = place_of(settings, ray, splits_of(s.layout));
    // Well below the 65,535 iterations, of all loops of an invocation, after which some drivers end loops
    // (docs/design/decisions.md, "How many iterations").
    const uint per_pass = std::max(1u, static_cast<uint>(16384 / steps_of_shadow_rays(s.layout)));
    for (uint first = 0; first < samples; first += per_pass)
        device.template run<kernels::direct_light>({pixels.elements, pixels.first, s.layout.features},
            {.strata = strata_of(samples),
                .first = first,
                .past = std::min(samples, first + per_pass),
                .branch = place.branch,
                .nth = place.nth,
                .seed = place.seed,
                .first_pixel = hits.first_pixel},
            reads(s.records, hits.points, hits.surfaces), writes(light));
}

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
