// The shares of light that the facets of rough metal and glass hide, for kernels (trace/rebounds.glsl).
#pragma once

#include <photongrid/scene/material.hpp>
#include <photongrid/scene/record_writer.hpp>
#include <photongrid/trace/coat_layout.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <tuple>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// Of light that meets facets once: the share that others hide, of what is reflected and of what is refracted.
struct hidden_light {
    double reflected = 0, refracted = 0;

    double all() const { return reflected + refracted; }
};

/// For light from this cosine, the mean over the facets that are visible from there. `index`: on the far side, relative
/// to that of the light; 0: of metal that reflects all. The error is below 0.002.
inline hidden_light hidden_by_facets(double cosine, double alpha, double index)
{
    // A lattice of Fibonacci numbers is as even as a grid of many more points.
    constexpr int facets = 2584, step = 1597;
    const glm::dvec3 from(std::sqrt(1 - cosine * cosine), 0, cosine), stretch(alpha, alpha, 1);
    const auto stretched = glm::normalize(from * stretch);
    const auto unhidden = [&](double c) {
        return c > 0 ? 2 * c / (c + std::sqrt(c * c + alpha * alpha * std::max(0.0, 1 - c * c))) : 0;
    };
    hidden_light sum;
    for (int n = 0; n < facets; ++n) {
        const double z = (1 - (n + 0.5) / facets) * (1 + stretched.z) - stretched.z,
                     sine = std::sqrt(std::max(0.0, 1 - z * z)),
                     turn = 2 * std::numbers::pi * ((n * step % facets + 0.5) / facets);
        const glm::dvec3 half_way = stretched + glm::dvec3(sine * std::cos(turn), sine * std::sin(turn), z);
        const auto facet = glm::normalize(half_way * stretch);
        const double met = std::clamp(glm::dot(from, facet), 0.0, 1.0);
        double reflected = 1;
        if (const double beyond2 = index > 0 ? 1 - (1 - met * met) / (index * index) : 0; beyond2 > 0) {
            reflected = dielectric_reflectance(met, index);
            const double leaving = from.z / index - facet.z * (met / index - std::sqrt(beyond2));
            sum.refracted += (1 - reflected) * (1 - unhidden(leaving));
        }
        sum.reflected += reflected * (1 - unhidden(2 * met * facet.z - from.z));
    }
    return {sum.reflected / facets, sum.refracted / facets};
}

/// The shares of a surface of one alpha, by the cosine, and their means over light that comes evenly.
struct hidden_shares {
    std::array<double, kernels::REBOUND_STEPS + 1> outside{}, inside{};
    double mean_outside = 0, mean_inside = 0;
    double crosses = 0; ///< of what is hidden outside, the share that leaves inside
};

/// `index`: of glass; 0: metal.
inline hidden_shares hidden_shares_of(double alpha, double index)
{
    constexpr uint steps = kernels::REBOUND_STEPS;
    const double spread = static_cast<double>(kernels::REBOUND_SPREAD) * alpha;
    const auto cosine_of = [&](uint n) { return std::min(1.0, spread * n / (steps * (1 + spread) - n)); };
    hidden_shares h;
    std::array<double, steps + 1> reflected{};
    for (uint n = 0; n <= steps; ++n) {
        const auto outside = hidden_by_facets(cosine_of(n), alpha, index);
        h.outside[n] = outside.all();
        reflected[n] = outside.reflected;
        h.inside[n] = index > 0 ? hidden_by_facets(cosine_of(n), alpha, 1 / index).all() : h.outside[n];
    }
    const auto mean = [&](const auto& shares) {
        double sum = 0;
        for (uint n = 0; n < steps; ++n) { // of a share that is linear between two cosines: see shares_of_coat
            const double a = cosine_of(n), b = cosine_of(n + 1);
            sum += (b - a) * ((2 * a + b) * shares[n] + (a + 2 * b) * shares[n + 1]) / 3;
        }
        return sum;
    };
    h.mean_outside = mean(h.outside);
    h.mean_inside = mean(h.inside);
    if (index > 0) {
        // What is reflected, hidden, and reflected once more leaves outside; the rest leaves inside. As much may come
        // back as there is.
        const double mean_reflected = 1 - shares_of_coat(index, 0).mean_passed;
        h.crosses = std::min(
            1 - mean_reflected * mean(reflected) / h.mean_outside, index * index * h.mean_inside / h.mean_outside);
    }
    return h;
}

/// Appends the tables of the materials whose facets scatter light several times, and enters them in their records.
/// Materials may share a table.
inline void write_rebounds(record_writer& w, std::vector<glm::vec4>& records, const std::vector<material>& materials)
{
    // Where the roughness has a texture, this many intervals up to the material's.
    constexpr uint intervals = 16;
    std::map<std::tuple<double, double, bool>, uint> written;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const auto& m = materials[i];
        if (!has_rebounds(m))
            continue;
        const double index = refracts(m) ? m.index_of_refraction : 0;
        const bool varies = m.roughness_texture.map != nullptr;
        const auto [found, is_new] = written.emplace(std::tuple(index, m.roughness, varies), w.next());
        if (is_new) {
            const auto put = [&](double alpha, const hidden_shares& h) {
                w.put(dvec3(h.mean_outside, h.mean_inside, 0) / (alpha * alpha) + dvec3(0, 0, h.crosses), 0);
            };
            w.put(dvec3(varies ? intervals : 1, varies ? intervals / m.roughness : 0, 0), 0);
            const auto alpha_at = [&](uint n) { // the first is not 0, of which the means, divided, would be infinite
                return varies ? std::pow(m.roughness * std::max(double(n), 0.25) / intervals, 2) : alpha_of(m);
            };
            auto low = hidden_shares_of(alpha_at(0), index);
            for (uint n = 0; n < (varies ? intervals : 1); ++n) {
                const auto high = varies ? hidden_shares_of(alpha_at(n + 1), index) : low;
                put(alpha_at(n), low);
                put(varies ? alpha_at(n + 1) : alpha_at(n), high);
                for (uint step = 0; step <= kernels::REBOUND_STEPS; ++step)
                    w.put(dvec3(low.outside[step], low.inside[step], high.outside[step]), high.inside[step]);
                low = high;
            }
        }
        records[kernels::FIRST_MATERIAL + kernels::MATERIAL_RECORDS * i + 1].w = static_cast<float>(found->second);
    }
}

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
