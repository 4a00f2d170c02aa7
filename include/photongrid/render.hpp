// A picture, in the two steps of figure 1: build_map when geometry or lights change, draw for every view.
//
//     scene -> trace_photons (2.1) -> sorted_map | routed_map (2.2) -> knn_search (2.3) -> image (2.4)
#pragma once

#include <photongrid/build_map.hpp>
#include <photongrid/edge_correction.hpp>
#include <photongrid/fitting_grid.hpp>
#include <photongrid/knn_grid_estimate.hpp>
#include <photongrid/render_stats.hpp>
#include <photongrid/trace_photons.hpp>

#include <chrono>

namespace photongrid {

namespace detail {
    /// Measures a stage of the paper's Table 1; waits for the device at both ends. Stages add up.
    template <backend B>
    class stage_clock {
    public:
        stage_clock(B& b, stage_stats& out) : b_(b), out_(out)
        {
            b_.finish();
            before_ = spent();
            start_ = std::chrono::steady_clock::now();
        }
        stage_clock(const stage_clock&) = delete;
        stage_clock& operator=(const stage_clock&) = delete;
        /// Ends the stage, with its buffers still held.
        void stop()
        {
            b_.finish();
            const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
            const auto now = spent();
            out_.compile_ms += now.compile_ms - before_.compile_ms;
            out_.ms += ms - (now.compile_ms - before_.compile_ms);
            out_.passes += now.passes - before_.passes;
            out_.device_bytes = std::max(out_.device_bytes, b_.bytes());
        }

    private:
        /// On all kernels so far.
        kernel_cost spent() const
        {
            kernel_cost all;
            for (const auto& [name, cost] : b_.costs()) {
                all.passes += cost.passes;
                all.compile_ms += cost.compile_ms;
            }
            return all;
        }
        B& b_;
        stage_stats& out_;
        kernel_cost before_;
        std::chrono::steady_clock::time_point start_;
    };
} // namespace detail

/// What build_map leaves for draw: the scene on the device and its photon map.
template <backend B>
struct built_map {
    device_scene<B> scene;   ///< recentred
    photon_map<B> map;       ///< in the coordinates of `scene`
    traced_photons<B> trace; ///< its photons have moved to `map`
    map_stats about;         ///< what draw repeats in its statistics
};

/// Traces photons and builds the map (figure 1, left). Needed again only when geometry, materials or lights change.
/// \throws std::invalid_argument for a scene or settings that check() refuses, std::runtime_error when the lights store
///         too few photons, backend_error when the device refuses, render_cancelled.
/// \snippet snippets.cpp build_map
template <backend B>
built_map<B> build_map(B& b, const scene& s, const render_settings& settings, const render_observer& observer, render_stats& stats)
{
    check(settings);
    built_map<B> built;
    built.scene = upload_scene(b, s);

    detail::stage_clock<B> tracing(b, stats.trace_photons);
    built.trace = trace_photons(b, s, built.scene, settings, observer);
    tracing.stop();

    detail::stage_clock<B> building(b, stats.build_map);
    photons<B> p = std::move(built.trace.photons);
    const grid g = settings.grid == glm::uvec3(0) ? fitting_grid(b, p, settings.k, b.caps().cells_a_radius) : make_grid(built.scene.about.low, built.scene.about.high, settings.grid);
    const uint parts = settings.only == light_part::caustic ? caustic_part : settings.only == light_part::indirect ? other_part : every_part;
    built.map = settings.builder == map_builder::sort ? sorted_map(b, std::move(p), g, parts) : routed_map(b, std::move(p), g, settings.slots, settings.seed, parts);
    building.stop();

    built.about.builder = settings.builder;
    built.about.cells = cell_count(g);
    built.about.resolution = glm::uvec3(g.resolution);
    built.about.overfull_cells = built.map.overfull_cells;
    built.about.left_out = built.map.left_out;
    stats.map = built.about;
    if (observer.progress)
        observer.progress("build_map", 1);
    return built;
}

namespace detail {
    /// Eye rays and where they ended, one element a pixel.
    template <backend B>
    struct eye_hits {
        buffer_of<B, glm::vec4> points, travels, weights, surfaces, emissions;

        eye_hits(B& b, std::size_t n)
            : points(b.template make<glm::vec4>(n)), travels(b.template make<glm::vec4>(n)), weights(b.template make<glm::vec4>(n)),
              surfaces(b.template make<glm::vec4>(n)), emissions(b.template make<glm::vec4>(n)) {}
    };

    /// The camera as eye_ray.glsl reads it.
    inline kernels::eye_ray::Params eye_params(const camera& c, const dvec3& center, const render_settings& s, uint sample)
    {
        check(c);
        const dvec3 forward = glm::normalize(c.look_at - c.position);
        const dvec3 right = glm::normalize(glm::cross(forward, c.up));
        const dvec3 up = glm::cross(right, forward);
        const double height = 2 * std::tan(glm::radians(c.vertical_fov) / 2);
        const double width = height * s.width / s.height;
        const auto narrow = [](const dvec3& v) { return glm::vec4(glm::vec3(v), 0.0f); };
        return {.position = narrow(c.position - center), .corner = narrow(forward - 0.5 * width * right + 0.5 * height * up), .right = narrow(right * (width / s.width)),
            .down = narrow(-up * (height / s.height)), .width = s.width, .sample_id = sample, .samples = s.spp, .seed = s.seed};
    }

    /// Shadow rays to every light from every hit, a bounded number a pass. Returns irradiance.
    template <backend B>
    buffer_of<B, glm::vec4> direct_light(B& b, const device_scene<B>& s, const eye_hits<B>& hits, const render_settings& settings, uint ray)
    {
        const auto n = hits.points.size();
        auto light = b.template make<glm::vec4>(n);
        b.template run<kernels::no_light>(n, {}, reads(), writes(light));
        // As square a grid of strata as the number of samples allows.
        const uint samples = (s.about.features & has_area_lights) != 0 ? settings.light_samples : 1u;
        uint rows = 1;
        for (uint r = 2; r * r <= samples; ++r)
            if (samples % r == 0)
                rows = r;
        // Drivers cut loops after 65,535 iterations, all lanes of a group together: shapes and their edges count.
        const auto& l = s.about.layout;
        const uint work = (l.round_things.y + l.round_things.w + l.flat_things.y + 5 * l.flat_things.w + 1) * l.rest.z;
        const uint a_pass = std::max(1u, 8192u / std::max(1u, work));
        for (uint first = 0; first < samples; first += a_pass)
            b.template run<kernels::direct_light>({n, 0u, s.about.features},
                {.scene_layout = l, .strata = {samples / rows, rows}, .first = first, .past = std::min(samples, first + a_pass), .ray_id = ray, .seed = settings.seed},
                reads(s.records, hits.points, hits.surfaces), writes(light));
        return light;
    }

    /// What to ask the photon map.
    inline knn_settings estimate_settings(const render_settings& s)
    {
        knn_settings k;
        k.k = s.k;
        k.max_radius = static_cast<float>(s.max_radius);
        k.search = s.search;
        k.kernel = s.kernel;
        k.bias = s.bias;
        k.leaks = s.leaks;
        k.errors = s.aov;
        return k;
    }

    inline image to_image(const std::vector<glm::vec4>& pixels, const render_settings& s, std::uint64_t& invalid)
    {
        image out;
        out.width = s.width;
        out.height = s.height;
        out.pixels.reserve(pixels.size());
        invalid = 0;
        for (const auto& p : pixels) {
            const bool good = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
            invalid += good ? 0u : 1u;
            out.pixels.push_back(good ? glm::vec3(p) : glm::vec3(0));
        }
        return out;
    }
} // namespace detail

/// Draws a view with a map that is there already (figure 1, right): no photon pass runs. Pixels that are NaN or infinite
/// are set to 0 and counted in stats.invalid_pixels.
/// \throws std::invalid_argument for a camera or settings that check() refuses, backend_error, render_cancelled.
/// \snippet snippets.cpp draw
template <backend B>
image draw(B& b, const built_map<B>& built, const camera& view, const render_settings& settings, const render_observer& observer, render_stats& stats)
{
    check(settings);
    const std::size_t n = std::size_t{settings.width} * settings.height;
    const auto& about = built.scene.about;
    auto pixels = b.template make<glm::vec4>(n);
    auto searches = b.template make<glm::vec4>(n);
    auto errors = b.template make<glm::vec4>(settings.aov ? n : 0);
    b.template run<kernels::no_light>(n, {}, reads(), writes(pixels));
    b.template run<kernels::no_light>(n, {}, reads(), writes(searches));
    b.template run<kernels::no_light>(errors.size(), {}, reads(), writes(errors));
    const bool with_direct = settings.only == light_part::all || settings.only == light_part::direct;

    // Rays split at the first two glass surfaces: 4 branches, each a pass over the picture.
    const uint branchings = (about.features & has_glass) != 0 ? 2u : 0u;
    const uint branches = 1u << branchings;
    for (uint ray = 0; ray < settings.spp * branches; ++ray) {
        const uint sample = ray / branches;
        if (observer.cancelled && observer.cancelled())
            throw render_cancelled();

        detail::stage_clock<B> tracing(b, stats.trace_rays);
        detail::eye_hits<B> hits(b, n);
        b.template run<kernels::eye_ray>(n, detail::eye_params(view, about.center, settings, sample), reads(),
            writes(hits.points, hits.travels, hits.weights, hits.surfaces, hits.emissions));
        b.template run_until_done<kernels::eye_bounce>({n, 0u, about.features},
            {.scene_layout = about.layout, .branch = ray % branches, .branchings = branchings, .depth = settings.depth, .sample_id = sample, .seed = settings.seed},
            reads(built.scene.records), writes(hits.points, hits.travels, hits.weights, hits.surfaces, hits.emissions), nowhere);
        auto direct = b.template make<glm::vec4>(with_direct ? 0 : n);
        if (with_direct) {
            direct = detail::direct_light(b, built.scene, hits, settings, ray);
        } else {
            b.template run<kernels::no_light>(n, {}, reads(), writes(direct));
            b.template run<kernels::no_light>(n, {}, reads(), writes(hits.emissions));
        }
        tracing.stop();
        if (observer.progress)
            observer.progress("trace_rays", static_cast<double>(ray + 1) / (settings.spp * branches));

        detail::stage_clock<B> estimating(b, stats.radiance_estimate);
        knn_settings wanted = detail::estimate_settings(settings);
        wanted.min_radius = least_radius(built.map.cells_of);
        const auto shade = [&](knn_search<B>& search, auto& target, auto& tally) {
            auto found = search.estimates();
            if (settings.edges != edge_correction::none)
                correct_edges(b, built.scene, hits.points, hits.surfaces, found, settings.kernel, wanted.min_radius);
            b.template run<kernels::shade>(n, {.scene_layout = about.layout, .share = 1.0f / static_cast<float>(settings.spp)},
                reads(built.scene.records, hits.points, hits.weights, hits.surfaces, hits.emissions, direct, found.irradiance, found.used), writes(target, tally));
            return found;
        };
        // The picture so far, with what this search holds.
        const auto show = [&](knn_search<B>& search) {
            auto running = b.template make<glm::vec4>(n);
            auto ignored = b.template make<glm::vec4>(n);
            b.template run<kernels::copy_light>(n, {}, reads(pixels), writes(running));
            b.template run<kernels::no_light>(n, {}, reads(), writes(ignored));
            shade(search, running, ignored);
            std::uint64_t invalid = 0;
            observer.intermediate(detail::to_image(b.download(running), settings, invalid));
        };
        if (settings.only == light_part::direct)
            wanted.max_radius = 0;
        const bool grows = wanted.search == search_kind::at_least_k;
        if (observer.intermediate && !grows)
            // Quick looks first: fewer photons are noisier, not darker (3.4).
            for (const uint divisor : {64u, 16u, 4u}) {
                knn_settings quick = wanted;
                quick.search = search_kind::exact_k;
                quick.k = std::max(wanted.k / divisor, 4u);
                knn_search<B> search(b, built.map, hits.points, hits.surfaces, quick);
                while (!search.advance(8).finished)
                    if (observer.cancelled && observer.cancelled())
                        throw render_cancelled();
                show(search);
            }
        if (observer.intermediate && grows) {
            // Watched, passes are small, and pictures come after 1, 2, 4, 8, … of them; the result is the same.
            wanted.visits_per_pass = 256;
            wanted.ranges_per_pass = 64;
        }
        knn_search<B> search(b, built.map, hits.points, hits.surfaces, wanted);
        uint passes = observer.intermediate && grows ? 1u : observer.cancelled || observer.intermediate ? 8u : nowhere;
        for (; !search.advance(passes).finished; passes *= observer.intermediate && grows ? 2u : 1u) {
            if (observer.cancelled && observer.cancelled())
                throw render_cancelled();
            if (observer.intermediate && grows)
                show(search);
        }
        const auto found = shade(search, pixels, searches);
        if (settings.aov)
            b.template run<kernels::tally_error>(n, {}, reads(hits.points, found.irradiance, found.standard_error), writes(errors));
        estimating.stop();
        if (observer.progress)
            observer.progress("radiance_estimate", static_cast<double>(ray + 1) / (settings.spp * branches));
    }

    // All passes have run: what is read from here on disturbs none.
    glm::dvec4 sum(0);
    const auto tallies = b.download(searches);
    for (const auto& p : tallies)
        sum += glm::dvec4(p);
    if (!(sum.w >= 0) || !(sum.w <= static_cast<double>(n) * settings.spp * branches))
        throw backend_error(b.caps().backend + ": shade: the device says that " + std::to_string(sum.w) + " points were searched for; there are " + std::to_string(n * settings.spp * branches));
    stats.estimate.points = static_cast<std::uint64_t>(sum.w);
    const double points = std::max(sum.w, 1.0);
    stats.estimate.mean_count = sum.x / points;
    stats.estimate.mean_radius = sum.y / points;
    stats.estimate.mean_visited = sum.z / points;
    stats.photons = count_photons(b, built.trace, built.map.photons.size());
    stats.map = built.about;
    if (built.about.builder == map_builder::route)
        stats.map.redistributed_flux = redistributed_flux(b, built.map);
    stats.peak_device_bytes = b.peak_bytes();
    image picture = detail::to_image(b.download(pixels), settings, stats.invalid_pixels);
    if (settings.aov) {
        const auto error_sums = b.download(errors);
        for (std::size_t i = 0; i < n; ++i) {
            const float mean = tallies[i].w > 0 ? 1.0f / tallies[i].w : 0.0f; // per search
            picture.layers.radius.push_back(tallies[i].y * mean);
            picture.layers.count.push_back(tallies[i].x * mean);
            picture.layers.relative_error.push_back(error_sums[i].x * mean);
        }
    }
    return picture;
}

/// Both steps at once, seen by the scene's own camera.
/// \throws what build_map and draw throw.
/// \snippet snippets.cpp render
template <backend B>
image render(B& b, const scene& s, const render_settings& settings, const render_observer& observer, render_stats& stats)
{
    const auto built = build_map(b, s, settings, observer, stats);
    return draw(b, built, s.camera, settings, observer, stats);
}

} // namespace photongrid
