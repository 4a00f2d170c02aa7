// Settings that nobody gave, from what a pilot measured (pilot.hpp): how the light of each kind varies, how much
// estimates blur it, and what it costs, in counts. They are a function of these alone, so that a picture has the same
// bytes on every machine.
#pragma once

#include <photongrid/scene/render_settings.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// What a pilot measures of the light in one kind of photon map. A share is that of the map's photons that an estimate
/// uses.
struct pilot_photons {
    double spread = 0;   ///< variance of a pixel from one eye ray to another
    double noise = 0;    ///< variance from one map to another, times the photons that an estimate uses
    double blur2 = 0;    ///< square of the bias of an estimate with the share blur_share
    double growth = 1;   ///< of the bias, as a power of the share
    double segments = 0; ///< of paths, for each photon that is asked for; 0: there are no photons
    double stored = 1;   ///< photons, for each that is asked for

    static constexpr double blur_share = 0.01;
    double bias2(double share) const { return blur2 * std::pow(share / blur_share, 2 * growth); }
};

/// What a pilot measures: means over pixels, of parts of the square of a pixel's radiance.
struct pilot_measures {
    double spread = 0;       ///< variance of direct light from one eye ray to another, with very many shadow rays
    double light_spread = 0; ///< variance of direct light from one shadow ray to another
    double edges = 1;        ///< of spread, that comes from edges: it is a power of the pixel's size
    std::array<pilot_photons, 2> maps; ///< of caustic photons, and of the others
    pilot_photons together;            ///< of both in one map, if there are caustic ones
    double pixels = 0;                 ///< of the picture
    double of_ray = 0;                 ///< cost of a segment of a path, by the scene's size; 1: of a few shapes
    double ends = 1;                   ///< of an eye ray, on diffuse surfaces
    double lamps = 0;                  ///< shadow rays for each of light_samples
};

namespace detail {
    /// The numbers of a pass, and what they make of it.
    struct pass_plan {
        std::array<double, 2> photons{};    ///< caustic photons, others (0 caustic ones: both kinds)
        std::array<double, 2> shares{};     ///< of them, that an estimate uses
        double light_samples = 1, rays = 1; ///< rays: per pixel

        const pilot_photons& map(const pilot_measures& m, std::size_t i) const
        {
            return i == 1 && photons[0] == 0 && m.together.segments > 0 ? m.together : m.maps[i];
        }
        /// In us, about, on the two processors that the constants were fitted on.
        double cost(const pilot_measures& m) const
        {
            const double ends = m.pixels * rays * m.ends;
            double all = ends * (0.12 + 0.03 * m.lamps * light_samples) * m.of_ray;
            for (std::size_t i = 0; i < 2; ++i)
                if (photons[i] > 0) {
                    const auto& of = map(m, i);
                    all += 1000 + photons[i] * (0.1 * std::sqrt(m.of_ray) * of.segments + 0.08 * of.stored)
                        + ends * (0.45 * m.of_ray - 0.2);
                }
            return all;
        }
        /// Of the picture after so many passes, as a part of the radiance squared. Radii shrink (shrinking_radii.hpp).
        double error(const pilot_measures& m, double passes) const
        {
            const double by_rays = of_rays(m, passes * rays);
            double all = m.spread * by_rays + m.light_spread / light_samples * std::pow(passes * rays, -1.25);
            for (std::size_t i = 0; i < 2; ++i)
                if (photons[i] > 0)
                    all += map(m, i).spread * by_rays + error_of_map(map(m, i), shares[i], photons[i], passes);
            return all;
        }
        /// Rays are stratified over all passes: variance falls faster than their number grows, most where an edge
        /// crosses a pixel.
        static double of_rays(const pilot_measures& m, double n) { return std::pow(n, -1.2 - 0.4 * m.edges); }
        static double error_of_map(const pilot_photons& of, double share, double photons, double passes)
        {
            const double shrunk = std::cbrt(passes);
            return of.noise / (share * photons * of.stored) * shrunk / passes + of.bias2(share / shrunk);
        }
    };

    /// By how much more the noise of soft light counts than its blur: blotches are seen, and a pilot of few photons
    /// takes some of them for blur.
    constexpr double weight_of_blotches = 3;

    /// The share of a map's photons with which an estimate adds least to the error of a picture of so many passes,
    /// where noise counts `weight` times, or that of `k` photons if that is not automatic.
    inline double best_share(pilot_photons of, double photons, double passes, std::uint32_t k, double weight = 1)
    {
        const double stored = photons * of.stored;
        of.noise *= weight;
        if (k != automatic_number)
            return std::min(k / stored, 1.0);
        double best = 0, least_error = std::numeric_limits<double>::infinity();
        for (double used = 8; used <= std::max(0.03 * stored, 8.0); used *= 1.25) {
            const double share = std::min(used / stored, 1.0);
            if (const double e = pass_plan::error_of_map(of, share, photons, passes); e < least_error) {
                least_error = e;
                best = share;
            }
        }
        return best;
    }
    /// A number that is given; or from `least` on to `most`, each `step` times the one before.
    inline std::vector<double> numbers_from(std::uint32_t given, double least, double most, double step)
    {
        std::vector<double> all;
        if (given != automatic_number)
            all.push_back(given);
        else
            for (double n = least; n <= most; n *= step)
                all.push_back(std::round(n));
        return all;
    }

    /// The plan of a pass with which a picture has the least error in its time, whatever ends it: a picture that goes
    /// on is the same picture.
    class best_plan {
    public:
        best_plan(const pilot_measures& m, const render_settings& s) : m_(m)
        {
            // More would take a GB.
            const double most = std::clamp(8 * m.pixels, 0x1p18, 0x1p21), rises = std::sqrt(2.0);
            const auto numbers = [&](const pilot_photons& of, std::uint32_t given) {
                return of.segments > 0 ? numbers_from(given, 64, most, rises) : std::vector<double>{0};
            };
            auto caustic_photons = numbers(m.maps[0], s.map.caustic_photons);
            const auto photons = numbers(m.maps[1].segments > 0 ? m.maps[1] : m.together, s.map.photons);
            const auto samples = numbers_from(s.view.light_samples, 1, m.lamps > 0 ? 16 : 1, 2);
            const double spp = s.view.spp == automatic_number ? 1 : s.view.spp;
            plan = {{caustic_photons.front(), photons.front()}, {0.02, 0.02}, samples.front(), spp};
            most_cost_ = std::max(time_of_pixel * m.pixels, passes_of_rays * plan.cost(m));
            if (s.map.caustic_photons == automatic_number && m.together.segments > 0)
                caustic_photons.push_back(0);
            for (double passes = least_passes; passes <= 4096; passes *= rises) {
                /// Numbers of photons, and the share of each that an estimate uses.
                const auto maps_of
                    = [&](const pilot_photons& of, const std::vector<double>& all, std::uint32_t k, double weight = 1) {
                          std::vector<std::array<double, 2>> maps;
                          if (of.segments > 0)
                              for (const double n : all)
                                  maps.push_back({n, n > 0 ? best_share(of, n, passes, k, weight) : 0.0});
                          else
                              maps.push_back({0, 0});
                          return maps;
                      };
                const auto others = maps_of(m.maps[1], photons, s.estimate.k, weight_of_blotches),
                           both = maps_of(m.together, photons, s.estimate.k);
                for (const auto& caustic : maps_of(m.maps[0], caustic_photons, s.estimate.caustic_k))
                    for (const auto& other : caustic[0] > 0 || m.together.segments == 0 ? others : both)
                        for (const double n : samples)
                            compare({{caustic[0], other[0]}, {caustic[1], other[1]}, n, spp}, passes);
            }
        }

        pass_plan plan;
        /// Photons of an estimate in the map of caustic photons, or in the other.
        double k(std::size_t map) const
        {
            return plan.photons[map] > 0 ? plan.shares[map] * plan.photons[map] * plan.map(m_, map).stored : 100;
        }
        /// As many as the time holds, or an error of 3 % of the light asks for.
        double passes() const
        {
            double n = least_passes;
            while (plan.error(m_, n) > aim && (n + 1) * plan.cost(m_) <= most_cost_)
                ++n;
            return n;
        }

    private:
        // The time is some 20 s for 512 x 512 pixels on two processors, or that of 32 passes with few photons.
        static constexpr double time_of_pixel = 80, passes_of_rays = 32, least_passes = 8, aim = 0.001;

        void compare(const pass_plan& other, double passes)
        {
            if (passes * other.cost(m_) > most_cost_)
                return;
            if (const double error = other.error(m_, passes); error < least_error_) {
                least_error_ = error;
                plan = other;
            }
        }

        const pilot_measures& m_;
        double most_cost_ = 0, least_error_ = std::numeric_limits<double>::infinity();
    };
} // namespace detail

/// `s` with numbers in place of automatic ones, by what a pilot measured.
inline render_settings chosen_settings(const pilot_measures& m, const render_settings& s)
{
    const detail::best_plan best(m, s);
    const auto whole = [](double x) { return static_cast<std::uint32_t>(std::max(std::round(x), 1.0)); };
    render_settings chosen;
    chosen.map.caustic_photons = best.plan.photons[0] > 0 ? whole(best.plan.photons[0]) : 0;
    chosen.map.photons = whole(best.plan.photons[1]);
    chosen.estimate.caustic_k = whole(best.k(0));
    // Blotches of fewer photons are seen, and where few photons lie in view a pilot takes the room for their blur.
    constexpr std::uint32_t least_k = 32;
    chosen.estimate.k = std::max(whole(best.k(1)), least_k);
    chosen.view.light_samples = whole(best.plan.light_samples);
    chosen.view.spp = whole(best.plan.rays);
    chosen.output.passes = s.output.has_stop_rule() ? 1 : whole(best.passes()); // 1: no limit
    return with_numbers(s, chosen);
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
