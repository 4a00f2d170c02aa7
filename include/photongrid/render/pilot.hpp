// Measures what decides about the settings that nobody gave, by small pictures (chosen_settings.hpp).
#pragma once

#include <photongrid/render/chosen_settings.hpp>
#include <photongrid/render/draw.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The radius of searches in place of an automatic one, m.
inline double radius_for(const scene_layout& l)
{
    return std::max(0.1 * static_cast<double>(glm::length(l.high - l.low)), 1e-6);
}

/// Draws the small pictures of a pilot, one a step.
template <backend B>
class pilot {
public:
    /// It draws nothing yet. `device` must outlive it. `settings`: with a number as max_radius.
    pilot(B& device, std::shared_ptr<world<B>> of, const scene& s, const render_settings& settings)
        : device_(device), world_(std::move(of)), view_(s.camera), settings_(settings),
          may_share_(settings.map.caustic_photons == automatic_number || settings.map.caustic_photons == 0),
          shrinks_(has_shrinking_radii(settings))
    {
        double shapes = std::max(static_cast<double>(count_shapes(s)) - 16, 0.0);
        for (const auto& m : s.meshes)
            shapes += static_cast<double>(m.surface->triangles.size());
        measures_.of_ray = 1 + 0.3 * std::log2(1 + shapes);
        measures_.lamps = static_cast<double>(std::min<std::size_t>(count_lights(s), 16));
        auto& o = settings_.output;
        measures_.pixels = static_cast<double>(o.width) * o.height;
        const double rays = std::max(2304 / std::exp2(detail::splits_of(world_->scene.layout)), 512.0);
        smaller_ = std::min(std::sqrt(rays / measures_.pixels), 1.0);
        for (auto* side : {&o.width, &o.height}) // even, so that there is one of half the size
            *side = std::max(2 * static_cast<uint>(std::round(*side * smaller_ / 2)), 2u);
        o.passes = 2; // with one, eye rays would go through the middles of pixels
        o.until_error = o.seconds = 0;
        o.report_bias = bias_report::no;
        o.aov = false;
        settings_.map.builder = map_builder::automatic;
        settings_.map.photons = settings_.map.caustic_photons = photons;
        settings_.estimate.k = settings_.estimate.caustic_k = some;
        settings_.estimate.radii = radius_kind::per_pass;
        settings_.estimate.indirect = indirect_kind::map;
        settings_.view.spp = settings_.view.light_samples = 1;
    }

    /// Draws one more picture. Returns whether it was the last.
    /// \throws backend_error.
    bool advance()
    {
        switch (step_++) {
        case 0: draw_direct(); break;
        case 1: draw_map(caustic_, light_part::caustic); break;
        case 2: draw_map(other_, light_part::indirect); break;
        case 3:
            if (caustic_.stored > 0 && may_share_)
                draw_map(together_, light_part::all);
            measure();
        }
        return step_ > 3;
    }
    const pilot_measures& measures() const { return measures_; }
    double fraction() const { return step_ / 4.0; }

private:
    static constexpr uint photons = 4096;
    static constexpr uint few = 12, some = 48, many = 192; ///< photons of an estimate

    using values = std::vector<double>; ///< by pixel, mean of the channels
    /// Of a map: with some photons by two eye rays, with few and with many by the first.
    struct drawn_from_map {
        values some, some_else, few, many;
    };
    struct drawn_maps {
        std::array<drawn_from_map, 2> maps;
        double segments = 0, stored = 0, asked = 0;
    };

    /// `radii`: the map in which the radii are found; null: `from`.
    values drawn(const built_map<B>& from, render_settings settings, uint pass, const built_map<B>* radii = nullptr)
    {
        render_stats stats;
        pass_options<B> options;
        for (std::size_t i = 0; radii != nullptr && i < radii->lights.size(); ++i)
            options.radii.firsts.push_back({&radii->lights[i].map, settings.estimate.k});
        const auto light = draw_pass(device_, from, view_, settings_of_pass(settings, pass), stats, options);
        values out;
        for (const auto& p : light.pixels) {
            const double mean = static_cast<double>(p.x + p.y + p.z) / 3;
            out.push_back(std::isfinite(mean) ? mean : 0);
        }
        counted_ = stats.photons;
        if (stats.estimate.points > 0)
            measures_.ends = static_cast<double>(stats.estimate.points) / static_cast<double>(out.size());
        return out;
    }
    void draw_direct()
    {
        const auto n = std::size_t{settings_.output.width} * settings_.output.height;
        direct_.fill(values(n));
        coarse_.fill(values(n / 4));
        if (!shows(light_part::direct))
            return;
        auto settings = settings_;
        settings.output.only = light_part::direct;
        const auto empty = build_map(device_, world_, settings);
        for (uint i = 0; i < 4; ++i)
            direct_[i] = drawn(empty, settings, i + 1);
        settings.view.light_samples = 4;
        for (uint i = 4; i < 8; ++i)
            direct_[i] = drawn(empty, settings, i + 1);
        settings.output.width /= 2;
        settings.output.height /= 2;
        for (uint i = 0; i < 4; ++i)
            coarse_[i] = drawn(empty, settings, i + 1);
    }
    bool shows(light_part part) const
    {
        return settings_.output.only == light_part::all || settings_.output.only == part;
    }
    void draw_map(drawn_maps& out, light_part only)
    {
        auto settings = settings_;
        settings.output.only = only;
        if (only == light_part::caustic && !may_have_caustics(world_->scene.layout))
            return;
        if (only == light_part::all)
            settings.map.caustic_photons = 0;
        if (!shows(only) || requests_of(settings, world_->scene.layout).empty())
            return;
        const auto with = [&](uint k) {
            settings.estimate.k = settings.estimate.caustic_k = k;
            return settings;
        };
        const auto map_of = [&](uint pass) { return build_map(device_, world_, settings_of_pass(with(some), pass)); };
        const std::array maps{map_of(1), map_of(2)};
        for (uint i = 0; i < 2; ++i) {
            const auto draw
                = [&](uint k, uint pass) { return drawn(maps[i], with(k), pass, shrinks_ ? &maps[1 - i] : nullptr); };
            auto& of = out.maps[i];
            of.some = draw(some, 1);
            out.segments += static_cast<double>(counted_.emitted + counted_.diffuse_hits);
            out.stored += static_cast<double>(counted_.stored);
            out.asked += static_cast<double>(counted_.asked);
            if (only != light_part::all) // its direct light varies, too
                of.some_else = draw(some, 2);
            of.few = draw(few, 1);
            of.many = draw(many, 1);
        }
    }

    /// Means over 2 x 2 pixels.
    values halved(const values& of) const
    {
        const std::size_t width = settings_.output.width;
        values out;
        for (std::size_t y = 0; y < settings_.output.height; y += 2)
            for (std::size_t i = y * width; i < (y + 1) * width; i += 2)
                out.push_back((of[i] + of[i + 1] + of[i + width] + of[i + width + 1]) / 4);
        return out;
    }
    /// Means over 3 x 3 pixels.
    values smoothed(const values& of) const
    {
        const auto& o = settings_.output;
        values out(of.size());
        for (uint y = 0; y < o.height; ++y)
            for (uint x = 0; x < o.width; ++x) {
                double sum = 0, count = 0;
                for (uint v = y - std::min(y, 1u); v <= std::min(y + 1, o.height - 1); ++v)
                    for (uint u = x - std::min(x, 1u); u <= std::min(x + 1, o.width - 1); ++u, ++count)
                        sum += of[std::size_t{v} * o.width + u];
                out[std::size_t{y} * o.width + x] = sum / count;
            }
        return out;
    }

    /// The mean over most of the pixels that are lit, of what is a part of the square of `light`.
    template <class OfPixel>
    double relative(const values& light, const OfPixel& of_pixel) const
    {
        values parts;
        for (std::size_t i = 0; i < light.size(); ++i)
            if (light[i] > 0)
                parts.push_back(of_pixel(i) / ((light[i] + dark_) * (light[i] + dark_)));
        if (parts.empty())
            return 0;
        const auto by_size = [](double x, double y) { return std::abs(x) < std::abs(y); };
        // What a ray meets by chance does not count.
        const auto kept
            = static_cast<std::ptrdiff_t>(parts.size() - std::min(parts.size() / 1000 + 1, parts.size() - 1));
        std::nth_element(parts.begin(), parts.begin() + kept - 1, parts.end(), by_size);
        return std::accumulate(parts.begin(), parts.begin() + kept, 0.0) / static_cast<double>(kept);
    }
    double variance(const values& light, const values& a, const values& b) const
    {
        return relative(light, [&](std::size_t i) { return (a[i] - b[i]) * (a[i] - b[i]) / 2; });
    }
    /// From a to b and from c to d.
    double variance(const values& light, const values& a, const values& b, const values& c, const values& d) const
    {
        return relative(
            light, [&](std::size_t i) { return ((a[i] - b[i]) * (a[i] - b[i]) + (c[i] - d[i]) * (c[i] - d[i])) / 4; });
    }

    void measure()
    {
        const auto n = direct_[0].size();
        light_ = values(n);
        const auto add = [&](const values& of, double weight) {
            for (std::size_t i = 0; i < of.size(); ++i)
                light_[i] += weight * of[i];
        };
        for (const auto& direct : direct_)
            add(direct, 1.0 / static_cast<double>(direct_.size()));
        for (const auto* drawn : {&caustic_, &other_})
            for (const auto& map : drawn->maps)
                add(map.some, 0.5);
        dark_ = 0.01 * std::accumulate(light_.begin(), light_.end(), 0.0) / static_cast<double>(n);
        light_ = smoothed(light_); // few samples of a pixel do not tell how bright it is

        auto& m = measures_;
        const auto of = [&](const values& light, const values* d) { return variance(light, d[0], d[1], d[2], d[3]); };
        const double one = of(light_, &direct_[0]), four = of(light_, &direct_[4]);
        m.light_spread = std::max((one - four) * 4 / 3, 0.0);
        m.spread = std::max(one - m.light_spread, 0.0);
        const double coarse = of(halved(light_), &coarse_[0]) - m.light_spread / 4;
        m.edges = m.spread > 0 && coarse > 0 ? 0.5 + 0.5 * std::clamp(std::log2(coarse / m.spread), 0.0, 1.0) : 1;
        m.spread *= std::pow(smaller_, m.edges);
        measure_map(caustic_, m.maps[0]);
        measure_map(other_, m.maps[1]);
        measure_map(together_, m.together);
        if (m.together.segments > 0)
            m.together.spread = m.maps[0].spread + m.maps[1].spread;
    }
    void measure_map(const drawn_maps& drawn, pilot_photons& map) const
    {
        if (drawn.stored < 1)
            return;
        const auto &a = drawn.maps[0], &b = drawn.maps[1];
        map.segments = drawn.segments / drawn.asked;
        map.stored = drawn.stored / drawn.asked;
        if (!a.some_else.empty())
            map.spread
                = std::pow(smaller_, measures_.edges) * variance(light_, a.some, a.some_else, b.some, b.some_else);
        map.noise = some * variance(light_, a.some, b.some);
        // Noise of maps that do not depend on each other drops out of products.
        const double of_few
            = relative(light_, [&](std::size_t i) { return (a.some[i] - a.few[i]) * (b.some[i] - b.few[i]); });
        const double of_many
            = relative(light_, [&](std::size_t i) { return (a.many[i] - a.some[i]) * (b.many[i] - b.some[i]); });
        // Its standard error, if the discs of estimates do not overlap.
        const double stored = drawn.stored / 2;
        const auto noise_of = [&](uint used) { return map.noise / used * std::sqrt(used / stored); };
        const bool by_few = of_few > 3 * noise_of(few);
        // Edges of the light decide where radii are small, smaller than here: blur grows as the fourth root of the
        // share there, or little faster.
        constexpr double least = 0.25, largest = 0.35;
        map.growth = by_few && of_many > 0           ? std::clamp(std::log2(of_many / of_few) / 4, least, largest)
            : by_few || of_many > 3 * noise_of(many) ? largest
                                                     : least;
        // The bias is a sum of such steps, from estimates without a radius on. Noise may hide half its standard error.
        const double steps = 1 / (1 - std::pow(4, -map.growth));
        map.blur2 = (by_few ? of_few : std::max(of_many, noise_of(many) / 2)) * steps * steps
            * std::pow(pilot_photons::blur_share * stored / (by_few ? some : many), 2 * map.growth);
    }

    B& device_;
    std::shared_ptr<world<B>> world_;
    camera view_;
    render_settings settings_;
    bool may_share_; ///< whether caustic photons may be in the map of the others
    bool shrinks_;   ///< whether a map of its own gives the radii
    int step_ = 0;
    std::array<values, 8> direct_;          ///< four with one shadow ray a lamp, four with four
    std::array<values, 4> coarse_;          ///< with four, of half the size
    drawn_maps caustic_, other_, together_; ///< the last: both in one map, and direct light
    values light_;                          ///< of the whole picture
    double dark_ = 0;                       ///< radiance at which errors become absolute ones
    double smaller_ = 1;                    ///< sides of the pictures, over those of the whole picture
    photon_stats counted_;                  ///< of the map that was drawn last
    pilot_measures measures_;
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
