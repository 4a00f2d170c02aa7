// What clear coats reflect and let pass, by integrals in double: over facets that are drawn evenly by the distribution
// of normals, and over reflections between coat and base.
#pragma once

#include <photongrid/scene/check.hpp>

#include <cmath>

namespace photongrid::testing {

/// Fresnel's reflectance of a dielectric from outside, for unpolarised light.
inline double unpolarised_reflectance(double cosine, double index)
{
    const double cos_t = std::sqrt(1 - (1 - cosine * cosine) / (index * index));
    const double s = (cosine - index * cos_t) / (cosine + index * cos_t),
                 p = (index * cosine - cos_t) / (index * cosine + cos_t);
    return (s * s + p * p) / 2;
}

/// The share of light from everywhere that facets by GGX, shadowed by Smith's formula, reflect once, seen at this
/// cosine; `reflectance`: of a facet, by the cosine at which it is met.
template <class Reflectance>
double albedo_of_facets(double cosine, double alpha, const Reflectance& reflectance, int steps = 200)
{
    const auto unhidden = [&](double c) { return 2 / (1 + std::sqrt(1 + alpha * alpha * (1 - c * c) / (c * c))); };
    const dvec3 view(std::sqrt(1 - cosine * cosine), 0, cosine);
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double u = (i + 0.5) / steps, angle = std::atan(alpha * std::sqrt(u / (1 - u))),
                         turn = M_PI * (j + 0.5) / steps;
            const dvec3 facet(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle));
            const double met = glm::dot(view, facet), leaving = 2 * met * facet.z - view.z;
            if (met > 0 && leaving > 0)
                sum += met / (cosine * facet.z) * unhidden(cosine) * unhidden(leaving) * reflectance(met);
        }
    return sum / (steps * steps);
}

/// A clear coat over a diffuse base. `alpha` 0: smooth.
struct known_coat {
    double index, alpha;

    double reflected(double cosine) const
    {
        const auto by_facet = [&](double met) { return unpolarised_reflectance(std::min(met, 1.0), index); };
        return alpha > 0 ? albedo_of_facets(cosine, alpha, by_facet, 100) : by_facet(cosine);
    }
    /// Of light that comes evenly from all directions outside.
    double mean_passed() const
    {
        constexpr int steps = 100;
        double sum = 0;
        for (int i = 0; i < steps; ++i) {
            const double sine2 = (i + 0.5) / steps; // even in this
            sum += 1 - reflected(std::sqrt(1 - sine2));
        }
        return sum / steps;
    }
    /// What leaves again of light that passed: after 1, 2, 3, ... reflections by the base.
    dvec3 left(const dvec3& base) const
    {
        const double leaves = mean_passed() / (index * index);
        dvec3 sum(0), inside(1);
        for (int times = 0; times < 10000; ++times) {
            inside *= base;
            sum += leaves * inside;
            inside *= 1 - leaves;
        }
        return sum;
    }
};

} // namespace photongrid::testing
