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
        : device_(device), world_(std::move(of)), view_(s.camera), settings_(settings)
    {
        double triangles = 0;
        for (const auto& m : s.meshes)
            triangles += static_cast<double>(m.surface->triangles.size());
        measures_.of_ray = 1 + 0.3 * std::log2(1 + triangles);
        measures_.branches = std::exp2(detail::splits_of(world_->scene.layout));
        measures_.lamps = static_cast<double>(std::min<std::size_t>(count_lights(s), 16));
        auto& o = settings_.output;
        measures_.pixels = static_cast<double>(o.width) * o.height;
        const double rays = std::max(2304 / measures_.branches, 512.0);
        const double smaller = std::min(std::sqrt(rays / measures_.pixels), 1.0);
        o.width = std::max(static_cast<uint>(std::round(o.width * smaller)), 1u);
        o.height = std::max(static_cast<uint>(std::round(o.height * smaller)), 1u);
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
        case 2: draw_map(other_, light_part::indirect); measure();
        }
        return step_ > 2;
    }
    const pilot_measures& measures() const { return measures_; }
    double fraction() const { return step_ / 3.0; }

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
        double segments = 0, stored = 0;
    };

    values drawn(const built_map<B>& from, render_settings settings, uint pass)
    {
        render_stats stats;
        const auto light = draw_pass(device_, from, view_, settings_of_pass(settings, pass), stats);
        values out;
        for (const auto& p : light.pixels) {
            const double mean = static_cast<double>(p.x + p.y + p.z) / 3;
            out.push_back(std::isfinite(mean) ? mean : 0);
        }
        counted_ = stats.photons;
        return out;
    }
    void draw_direct()
    {
        direct_.fill(values(std::size_t{settings_.output.width} * settings_.output.height));
        if (!shows(light_part::direct))
            return;
        auto settings = settings_;
        settings.output.only = light_part::direct;
        const auto empty = build_map(device_, world_, settings);
        for (uint i = 0; i < 4; ++i)
            direct_[i] = drawn(empty, settings, i + 1);
        settings.view.light_samples = 4;
        for (uint i = 0; i < 2; ++i)
            direct_[4 + i] = drawn(empty, settings, i + 1);
    }
    bool shows(light_part part) const
    {
        return settings_.output.only == light_part::all || settings_.output.only == part;
    }
    void draw_map(drawn_maps& out, light_part only)
    {
        auto settings = settings_;
        settings.output.only = only;
        if (!shows(only) || requests_of(settings, world_->scene.layout).empty())
            return;
        for (uint i = 0; i < 2; ++i) {
            auto& of = out.maps[i];
            const auto with = [&](uint k) {
                settings.estimate.k = settings.estimate.caustic_k = k;
                return settings;
            };
            const auto map = build_map(device_, world_, settings_of_pass(with(some), i + 1));
            of.some = drawn(map, with(some), 1);
            out.segments += static_cast<double>(counted_.emitted + counted_.diffuse_hits);
            out.stored += static_cast<double>(counted_.stored);
            of.some_else = drawn(map, with(some), 2);
            of.few = drawn(map, with(few), 1);
            of.many = drawn(map, with(many), 1);
        }
    }

    void measure()
    {
        const auto n = direct_[0].size();
        const auto at = [](const values& of, std::size_t i) { return of.empty() ? 0.0 : of[i]; };
        const auto in = [&](const drawn_maps& of, std::size_t i) {
            return (at(of.maps[0].some, i) + at(of.maps[1].some, i)) / 2;
        };
        values light(n);
        double all = 0;
        for (std::size_t i = 0; i < n; ++i)
            all += light[i] = (direct_[4][i] + direct_[5][i]) / 2 + in(caustic_, i) + in(other_, i);
        const double dark = 0.01 * all / static_cast<double>(n);
        /// The mean over most of the pixels that are lit, of what is a part of the radiance squared.
        const auto relative = [&](const auto& of_pixel) {
            values parts;
            for (std::size_t i = 0; i < n; ++i)
                if (light[i] > 0)
                    parts.push_back(of_pixel(i) / ((light[i] + dark) * (light[i] + dark)));
            if (parts.empty())
                return 0.0;
            const auto by_size = [](double x, double y) { return std::abs(x) < std::abs(y); };
            // What a ray meets by chance does not count.
            const auto kept = static_cast<std::ptrdiff_t>(parts.size() - parts.size() / 100);
            std::nth_element(parts.begin(), parts.begin() + kept - 1, parts.end(), by_size);
            return std::accumulate(parts.begin(), parts.begin() + kept, 0.0) / static_cast<double>(kept);
        };
        const auto variance = [](double x, double y) { return (x - y) * (x - y) / 2; };
        auto& m = measures_;
        const double one = relative([&](std::size_t i) {
            return (variance(direct_[0][i], direct_[1][i]) + variance(direct_[2][i], direct_[3][i])) / 2;
        });
        const double four = relative([&](std::size_t i) { return variance(direct_[4][i], direct_[5][i]); });
        m.light_spread = std::max((one - four) * 8 / 7, 0.0); // of four, an eighth: see pass_plan::error
        m.spread = std::max(one - m.light_spread, 0.0);
        const drawn_maps* const drawn[] = {&caustic_, &other_};
        for (std::size_t k = 0; k < 2; ++k) {
            if (drawn[k]->stored < 1)
                continue;
            const auto &a = drawn[k]->maps[0], &b = drawn[k]->maps[1];
            auto& map = m.maps[k];
            map.segments = drawn[k]->segments / drawn[k]->stored;
            map.spread = relative([&](std::size_t i) {
                return (variance(a.some[i], a.some_else[i]) + variance(b.some[i], b.some_else[i])) / 2;
            });
            map.noise = some * relative([&](std::size_t i) { return variance(a.some[i], b.some[i]); });
            // Noise of maps that do not depend on each other drops out of products.
            const double of_few
                = relative([&](std::size_t i) { return (a.some[i] - a.few[i]) * (b.some[i] - b.few[i]); });
            const double of_many
                = relative([&](std::size_t i) { return (a.many[i] - a.some[i]) * (b.many[i] - b.some[i]); });
            // Its standard error, if the discs of estimates do not overlap.
            const double stored = drawn[k]->stored / 2;
            const auto noise_of = [&](uint used) { return map.noise / used * std::sqrt(used / stored); };
            const bool by_few = of_few > 3 * noise_of(few);
            // Where radii are small, edges of the light decide: there blur grows as the fourth root of the share.
            constexpr double least = 0.25, largest = 0.6;
            map.growth = by_few && of_many > 0           ? std::clamp(std::log2(of_many / of_few) / 4, least, largest)
                : by_few || of_many > 3 * noise_of(many) ? largest
                                                         : least;
            // The bias is a sum of such steps, from estimates without a radius on. Noise may hide as much as that.
            const double steps = 1 / (1 - std::pow(4, -map.growth));
            map.blur2 = (by_few ? of_few : std::max(of_many, noise_of(many) / 4)) * steps * steps
                * std::pow(pilot_photons::blur_share * stored / (by_few ? some : many), 2 * map.growth);
        }
    }

    B& device_;
    std::shared_ptr<world<B>> world_;
    camera view_;
    render_settings settings_;
    int step_ = 0;
    std::array<values, 6> direct_; ///< four with one shadow ray a lamp, two with four
    drawn_maps caustic_, other_;
    photon_stats counted_; ///< of the map that was drawn last
    pilot_measures measures_;
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
