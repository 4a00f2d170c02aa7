// The shares of light that a clear coat reflects and lets pass, for kernels (trace/coat.glsl).
#pragma once

#include <photongrid/scene/material.hpp>
#include <photongrid/scene/record_writer.hpp>
#include <photongrid/trace/scene_layout.kernel.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// What a coat does with light from outside, and with diffuse light below it.
struct coat_shares {
    double mean_passed = 1;     ///< of light that comes evenly from all directions outside
    double thrown_back = 0;     ///< of diffuse light below
    std::vector<double> passed; ///< of a rough coat: of light from the cosines 0, 1 / COAT_STEPS, ... 1
};

/// Fresnel's reflectance of a dielectric for unpolarised light from outside.
inline double dielectric_reflectance(double cosine, double index)
{
    const double below = std::sqrt(1 - (1 - cosine * cosine) / (index * index));
    const double s = (cosine - index * below) / (cosine + index * below),
                 p = (index * cosine - below) / (index * cosine + below);
    return 0.5 * (s * s + p * p);
}

/// The share of light that a rough coat reflects: the mean over the facets that are visible from the light, of which
/// each reflects as a smooth coat does what no other facet hides (trace/microfacet.glsl).
inline double reflected_by_facets(double cosine, double index, double alpha)
{
    constexpr int rings = 64, sectors = 32;
    const glm::dvec3 from(std::sqrt(1 - cosine * cosine), 0, cosine);
    const auto stretched = glm::normalize(from * glm::dvec3(alpha, alpha, 1));
    double sum = 0;
    for (int ring = 0; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector) {
            const double z = (1 - (ring + 0.5) / rings) * (1 + stretched.z) - stretched.z,
                         sine = std::sqrt(std::max(0.0, 1 - z * z)), turn = std::numbers::pi * (sector + 0.5) / sectors;
            const auto half_way = stretched + glm::dvec3(sine * std::cos(turn), sine * std::sin(turn), z);
            const auto facet = glm::normalize(half_way * glm::dvec3(alpha, alpha, 1));
            const double met = glm::dot(from, facet), leaving = 2 * met * facet.z - from.z;
            if (leaving > 0)
                sum += dielectric_reflectance(std::clamp(met, 0.0, 1.0), index) * 2 * leaving
                    / (leaving + std::hypot(leaving, alpha * std::sqrt(std::max(0.0, 1 - leaving * leaving))));
        }
    return sum / (rings * sectors);
}

/// `alpha`: of the distribution of facets; 0: smooth.
inline coat_shares shares_of_coat(double index, double alpha)
{
    coat_shares c;
    // The mean of a share that is linear between cosines a and b is that of 2 * cosine * share.
    double sum = 0;
    const auto add_linear = [&](double a, double b, double at_a, double at_b) {
        sum += (b - a) * ((2 * a + b) * at_a + (a + 2 * b) * at_b) / 3;
    };
    if (alpha > 0) {
        for (uint n = 0; n <= kernels::COAT_STEPS; ++n)
            c.passed.push_back(1 - reflected_by_facets(double(n) / kernels::COAT_STEPS, index, alpha));
        for (std::size_t n = 0; n + 1 < c.passed.size(); ++n)
            add_linear(
                double(n) / kernels::COAT_STEPS, double(n + 1) / kernels::COAT_STEPS, c.passed[n], c.passed[n + 1]);
    } else {
        constexpr int steps = 4096;
        const auto passed = [&](int n) { return 1 - dielectric_reflectance(double(n) / steps, index); };
        for (int n = 0; n < steps; ++n)
            add_linear(double(n) / steps, double(n + 1) / steps, passed(n), passed(n + 1));
    }
    c.mean_passed = sum;
    // As much light passes from below as from outside of the same radiance, if that is divided by the squared index.
    c.thrown_back = 1 - c.mean_passed / (index * index);
    return c;
}

/// Appends the records of coats, and enters them in those of their materials. Materials may share the records of a
/// coat.
inline void write_coats(record_writer& w, std::vector<glm::vec4>& records, const std::vector<material>& materials)
{
    std::map<std::pair<double, double>, uint> written;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const auto& m = materials[i];
        if (!is_coated(m))
            continue;
        const double alpha = alpha_of(m);
        const auto [found, is_new] = written.emplace(std::pair(m.index_of_refraction, alpha), w.next());
        if (is_new) {
            const coat_shares c = shares_of_coat(m.index_of_refraction, alpha);
            w.put(dvec3(c.mean_passed, c.thrown_back, 0), 0);
            for (std::size_t n = 0; n + 2 < c.passed.size(); n += 2)
                w.put(dvec3(c.passed[n], c.passed[n + 1], c.passed[n + 2]), 0);
        }
        records[kernels::FIRST_MATERIAL + kernels::MATERIAL_RECORDS * i + 1].w = static_cast<float>(found->second);
    }
}

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
