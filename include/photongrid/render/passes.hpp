// One pass of several: its random numbers, its pixels and its statistics.
#pragma once

#include <photongrid/render/film.hpp>
#include <photongrid/render/previews.hpp>
#include <photongrid/render/scene_map.hpp>
#include <photongrid/render/view_pass.hpp>

#include <bit>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The settings of pass number `pass` of a picture with settings `s`, with a seed of its own. Pass 0 has the seed of
/// `s`.
inline render_settings settings_of_pass(render_settings s, std::uint32_t pass)
{
    s.output.passes = s.output.passes_at_most();
    if (pass > 0) {
        // Two rounds of splitmix64 (Steele, Lea and Flood 2014) over (seed, pass).
        std::uint64_t x = (std::uint64_t{s.seed} << 32 | pass) + 0x9E3779B97F4A7C15u;
        for (int round = 0; round < 2; ++round) {
            x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
            x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
            x ^= x >> 31;
        }
        const auto seed = static_cast<std::uint32_t>(x >> 32);
        s.pass = {pass, seed ^ s.seed};
        s.seed = seed;
    }
    return s;
}

/// The settings of the map that gives the first radii of all passes. It needs few photons: k is capped, and the number
/// of photons scaled alike. It is built once and searched in every pass. Most query points lie far from caustics, where
/// block maps are faster, so devices that prefer them get one; exact searches find the same radii in it.
inline render_settings settings_of_radius_map(const render_settings& s, const capabilities& device)
{
    auto with = settings_of_pass(s, radius_pass);
    const auto make_fewer = [](std::uint32_t& photons, std::uint32_t& k) {
        const auto sought = std::min(k, most_for_first_radius);
        photons = static_cast<std::uint32_t>((std::uint64_t{photons} * sought + k - 1) / k);
        k = sought;
    };
    make_fewer(with.map.photons, with.estimate.k);
    make_fewer(with.map.caustic_photons, with.estimate.sought(true));
    if (device.prefers_blocks && s.estimate.search == search_kind::exact_k && s.map.builder != map_builder::route)
        with.map.builder = map_builder::blocks;
    if (gathers(s) && s.map.caustic_photons > 0)
        with.output.only = light_part::caustic; // rays end in the map of caustic photons alone
    return with;
}

/// A power of two near the mean radiance of a scene, as the unit of a film: the power of all lights divided by the
/// square of the extent of the diffuse surfaces.
inline double typical_radiance(const scene& s, const scene_layout& layout)
{
    const double extent = static_cast<double>(glm::length(layout.high - layout.low));
    const double radiance = detail::power_of_lights(s) / (extent * extent);
    return std::isfinite(radiance) && radiance > 0 ? std::exp2(std::round(std::log2(radiance))) : 1.0;
}

/// The film for the passes of a picture.
inline film film_for(const scene& s, const scene_layout& layout, const render_settings& settings)
{
    const auto& output = settings.output;
    return film(output.width, output.height, typical_radiance(s, layout), output.aov, reports_bias(settings),
        settings.estimate.filter);
}

namespace detail {
    inline void add(photon_stats& sum, const photon_stats& p)
    {
        sum.asked += p.asked;
        sum.emitted += p.emitted;
        sum.absorbed += p.absorbed;
        sum.escaped += p.escaped;
        sum.cut_off += p.cut_off;
        sum.invalid += p.invalid;
        sum.diffuse_hits += p.diffuse_hits;
        sum.stored += p.stored;
        sum.direct += p.direct;
        sum.left_to_caustics += p.left_to_caustics;
        sum.dropped += p.dropped;
    }

    inline void add(stage_stats& sum, const stage_stats& s)
    {
        sum.ms += s.ms;
        sum.compile_ms += s.compile_ms;
        sum.passes += s.passes;
        sum.device_bytes = std::max(sum.device_bytes, s.device_bytes);
    }

    /// Adds the statistics of a pass's map.
    inline void add_map(render_stats& sum, const render_stats& map)
    {
        add(sum.trace_photons, map.trace_photons);
        add(sum.build_map, map.build_map);
        sum.map = map.map;
    }

    /// Adds a sum of pass_pixels::searches to the statistics.
    inline void add(estimate_stats& sum, const glm::dvec4& searches)
    {
        const double before = static_cast<double>(sum.points), all = std::max(before + searches.w, 1.0);
        sum.mean_count = (sum.mean_count * before + searches.x) / all;
        sum.mean_radius = (sum.mean_radius * before + searches.y) / all;
        sum.mean_visited = (sum.mean_visited * before + searches.z) / all;
        sum.points += static_cast<std::uint64_t>(searches.w);
    }
} // namespace detail

/// Reads the pixels of a finished band of a pass back, adds them to those above, and its searches to `stats`.
/// \throws backend_error if the device fails, or reports more searches than there were.
template <backend B>
void finish_band(B& device, const view_pass<B>& view, pass_pixels& light, render_stats& stats)
{
    const auto append = [&](std::vector<glm::vec4>& all, const std::vector<glm::vec4>& more) {
        all.reserve(view.picture_size()); // one allocation: growth would double the peak
        all.insert(all.end(), more.begin(), more.end());
    };
    const auto& band = view.light();
    const auto searches = device.download(band.searches);
    const double searched = static_cast<double>(searches.size()) * view.searches();
    glm::dvec4 sum(0);
    for (const auto& s : searches)
        sum += glm::dvec4(s);
    if (!(sum.w >= 0) || !(sum.w <= searched))
        throw backend_error(device.caps().backend + ": shade: the device returned " + std::to_string(sum.w)
            + " as the number of searches; there are at most " + std::to_string(searched));
    detail::add(stats.estimate, sum);
    append(light.pixels, device.download(band.pixels));
    if (band.errors.size() > 0) {
        append(light.searches, searches);
        append(light.errors, device.download(band.errors));
    }
    if (const auto& b = band.biases; b.bias.size() > 0) {
        append(light.biases.bias, device.download(b.bias));
        append(light.biases.tilt, device.download(b.tilt));
        append(light.biases.jump, device.download(b.jump));
    }
}

/// Adds the counts of a finished pass to `stats`.
/// \throws backend_error if the device fails.
template <backend B>
void finish_pass(B& device, const built_map<B>& built, render_stats& stats)
{
    for (const auto& light : built.lights)
        detail::add(stats.photons, count_photons(device, light.trace));
    stats.map = built.stats.map;
    if (built.stats.map.builder == map_builder::route)
        stats.map.redistributed_power = redistributed_power(device, built.map());
    stats.peak_device_bytes = device.peak_bytes();
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
