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
    double segments = 0; ///< of paths, for each photon that is stored; 0: there are no photons

    static constexpr double blur_share = 0.01;
    double bias2(double share) const { return blur2 * std::pow(share / blur_share, 2 * growth); }
};

/// What a pilot measures: means over pixels, of parts of the square of a pixel's radiance.
struct pilot_measures {
    double spread = 0;       ///< variance of direct light from one eye ray to another, with very many shadow rays
    double light_spread = 0; ///< variance of direct light from one shadow ray to another
    std::array<pilot_photons, 2> maps; ///< of caustic photons, and of the others
    double pixels = 0;                 ///< of the picture
    double of_ray = 0;                 ///< cost of a segment of a path, by the scene's size; 1: of a few shapes
    double branches = 1;               ///< of an eye ray
    double lamps = 0;                  ///< shadow rays for each of light_samples
};

namespace detail {
    /// The numbers of a pass, and what they make of it.
    struct pass_plan {
        std::array<double, 2> photons{}; ///< caustic photons, others
        std::array<double, 2> shares{};  ///< of them, that an estimate uses
        double light_samples = 1;

        /// In us, about, on the two processors that the constants were fitted on.
        double cost(const pilot_measures& m) const
        {
            double all = 0;
            for (std::size_t i = 0; i < 2; ++i)
                if (photons[i] > 0)
                    all += photons[i] * (0.1 + 0.1 * m.of_ray * m.maps[i].segments) + m.pixels * m.branches * 0.4;
            return all + m.pixels * m.branches * (0.1 + 0.03 * m.lamps * light_samples) * m.of_ray;
        }
        /// Of the picture after so many passes, as a part of the radiance squared. Radii shrink (shrinking_radii.hpp).
        double error(const pilot_measures& m, double passes) const
        {
            // Rays are stratified over all passes: where an edge crosses a stratum, variance falls as n^-1.5.
            double all = (m.spread + m.light_spread * std::pow(light_samples, -1.5)) * std::pow(passes, -1.5);
            for (std::size_t i = 0; i < 2; ++i)
                if (photons[i] > 0)
                    all += m.maps[i].spread * std::pow(passes, -1.5)
                        + error_of_map(m.maps[i], shares[i], photons[i], passes);
            return all;
        }
        static double error_of_map(const pilot_photons& of, double share, double photons, double passes)
        {
            const double shrunk = std::cbrt(passes);
            return of.noise / (share * photons) * shrunk / passes + of.bias2(share / shrunk);
        }
    };

    /// What a map with so many photons makes of the error of a picture of so many passes, with the share that is best.
    struct map_plan {
        double photons = 0, share = 0, error = 0;
    };
    inline map_plan best_map(const pilot_photons& of, double photons, double passes)
    {
        map_plan best{photons, 0, std::numeric_limits<double>::infinity()};
        for (double used = 8; used <= std::max(0.03 * photons, 8.0); used *= 1.25)
            if (const double e = pass_plan::error_of_map(of, used / photons, photons, passes); e < best.error)
                best = {photons, used / photons, e};
        return best;
    }
} // namespace detail

/// `s` with numbers in place of automatic ones, by what a pilot measured.
inline render_settings chosen_settings(const pilot_measures& m, render_settings s)
{
    using one = std::vector<double>;
    const auto given = [](std::uint32_t number, double otherwise) {
        return number == automatic_number ? otherwise : static_cast<double>(number);
    };
    const auto steps_of = [](std::uint32_t number, double least, double most, double step) {
        std::vector<double> all;
        if (number != automatic_number)
            all.push_back(number);
        else
            for (double n = least; n <= most; n *= step)
                all.push_back(std::round(n));
        return all;
    };
    // The numbers with which a picture has the least error in its time, whatever ends it: a picture that goes on is the
    // same picture. That is some 20 s for 512 x 512 pixels on two processors, or that of 32 passes without photons.
    // Unless something else ends it, it ends before at an error of 3 % of the light.
    constexpr double time_of_pixel = 80, passes_of_rays = 32, aim = 0.001;
    const double most = std::max(8 * m.pixels, 200'000.0), rises = std::sqrt(2.0);
    const auto all_of = [&](std::size_t map, std::uint32_t number) {
        return m.maps[map].segments > 0 ? steps_of(number, 64, most, rises) : one{0};
    };
    const auto least_of = [&](std::size_t map, std::uint32_t number) { return all_of(map, number).front(); };
    detail::pass_plan best{{least_of(0, s.map.caustic_photons), least_of(1, s.map.photons)}, {0.02, 0.02}, 1};
    const double most_cost = std::max(time_of_pixel * m.pixels, passes_of_rays * best.cost(m));
    double least = std::numeric_limits<double>::infinity();
    for (double passes = 8; passes <= 4096; passes *= rises) {
        std::array<std::vector<detail::map_plan>, 2> maps;
        for (std::size_t i = 0; i < 2; ++i)
            for (const double n : all_of(i, i == 0 ? s.map.caustic_photons : s.map.photons))
                maps[i].push_back(n > 0 ? detail::best_map(m.maps[i], n, passes) : detail::map_plan{});
        for (const auto& caustic : maps[0])
            for (const auto& other : maps[1])
                for (const double samples : steps_of(s.view.light_samples, 1, m.lamps > 0 ? 16 : 1, 2)) {
                    const detail::pass_plan plan{
                        {caustic.photons, other.photons}, {caustic.share, other.share}, samples};
                    if (passes * plan.cost(m) > most_cost)
                        continue;
                    if (const double error = plan.error(m, passes); error < least) {
                        least = error;
                        best = plan;
                    }
                }
    }
    const auto whole = [](double x) { return static_cast<std::uint32_t>(std::max(std::round(x), 1.0)); };
    const auto sought = [&](std::uint32_t number, std::size_t map) {
        return whole(given(number, best.photons[map] > 0 ? best.shares[map] * best.photons[map] : 100));
    };
    if (s.map.caustic_photons == automatic_number)
        s.map.caustic_photons = best.photons[0] > 0 ? whole(best.photons[0]) : 0;
    if (s.map.photons == automatic_number)
        s.map.photons = whole(best.photons[1]);
    s.estimate.caustic_k = sought(s.estimate.caustic_k, 0);
    s.estimate.k = sought(s.estimate.k, 1);
    if (s.view.light_samples == automatic_number)
        s.view.light_samples = whole(best.light_samples);
    s.view.spp = whole(given(s.view.spp, 1));
    if (s.output.passes == automatic_number) {
        double passes = 8;
        while (best.error(m, passes) > aim && (passes + 1) * best.cost(m) <= most_cost)
            ++passes;
        s.output.passes = s.output.has_stop_rule() ? 1 : whole(passes); // 1: no limit
    }
    return s;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
