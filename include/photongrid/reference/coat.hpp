// Diffuse surfaces under a clear coat, for the reference renderer. What a rough coat reflects is found by the facet
// that a ray meets, without a table.
#pragma once

#include <photongrid/reference/bsdf.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// Fresnel's reflectance of a coat; `cosine` outside.
inline double coat_reflectance(double cosine, double index)
{
    const double cos_i = std::min(1.0, cosine);
    return fresnel_reflectance(cos_i, 1, std::sqrt(1 - (1 - cos_i * cos_i) / (index * index)), index);
}

/// A facet that is visible against d, for u and v in [0, 1); `normal` is on that side (Heitz, Sampling the GGX
/// Distribution of Visible Normals, 2018).
inline dvec3 visible_facet(const dvec3& normal, const dvec3& d, double alpha, double u, double v)
{
    const dvec3 x = across(normal), y = glm::cross(normal, x);
    const dvec3 view(-glm::dot(d, x), -glm::dot(d, y), -glm::dot(d, normal));
    const dvec3 stretched = glm::normalize(view * dvec3(alpha, alpha, 1));
    const double length = std::hypot(stretched.x, stretched.y);
    const dvec3 first = length > 0 ? dvec3(-stretched.y, stretched.x, 0) / length : dvec3(1, 0, 0),
                second = glm::cross(stretched, first);
    const double r = std::sqrt(u), turn = 2 * std::numbers::pi * v, along = r * std::cos(turn),
                 half = 0.5 * (1 + stretched.z), height = std::sqrt(std::max(0.0, 1 - along * along)),
                 aside = (1 - half) * height + half * r * std::sin(turn);
    const dvec3 of_hemisphere
        = along * first + aside * second + std::sqrt(std::max(0.0, 1 - along * along - aside * aside)) * stretched;
    const dvec3 facet
        = glm::normalize(dvec3(alpha * of_hemisphere.x, alpha * of_hemisphere.y, std::max(0.0, of_hemisphere.z)));
    return facet.x * x + facet.y * y + facet.z * normal;
}

/// What a coat reflects of light along d, by a random facet if it is rough. Its weight is the share, at most 1; the
/// rest passes the coat.
inline specular_bounce off_coat(const material& m, const hit& h, const dvec3& d, random_stream& random, bool from_light)
{
    const facing_normals n(h, d);
    if (!is_rough(m)) {
        auto bounce = from_light ? specular_of_light(m, h, d, random) : specular(m, h, d, random);
        bounce.weight = coat_reflectance(-glm::dot(n.shading, d), m.index_of_refraction);
        return bounce;
    }
    const double alpha = m.roughness * m.roughness, u = random(), v = random();
    const dvec3 facet = visible_facet(n.shading, d, alpha, u, v);
    const double met = -glm::dot(d, facet);
    specular_bounce bounce{glm::normalize(d + 2 * met * facet)};
    const double leaving = glm::dot(bounce.direction, n.shading), geometric = glm::dot(bounce.direction, n.geometric);
    bounce.weight = 0;
    if (met > 0 && leaving > 0 && geometric > 0) {
        bounce.weight = coat_reflectance(met, m.index_of_refraction) * unhidden(leaving, alpha);
        bounce.adjoint
            = std::min(8.0, std::abs(glm::dot(d, n.shading) * geometric / (glm::dot(d, n.geometric) * leaving)));
    }
    return bounce;
}

/// The share of light along d that passes the coat of the surface; random, with the right mean; 1 without a coat.
inline double passes_coat(const material& m, const hit& h, const dvec3& d, random_stream& random)
{
    return is_coated(m) ? 1 - off_coat(m, h, d, random, false).weight : 1;
}

/// How a coat changes what a diffuse surface reflects.
class diffuse_base {
public:
    explicit diffuse_base(const material& m)
    {
        if (!is_coated(m))
            return;
        // The mean over light that comes evenly from all directions, by midpoints of angles.
        constexpr int steps = 256;
        const hit flat{.normal = {0, 0, 1}, .shading = {0, 0, 1}};
        random_stream random(1, 5, 0);
        double sum = 0;
        for (int i = 0; i < steps; ++i) {
            const double angle = (i + 0.5) / steps * std::numbers::pi / 2;
            const dvec3 d(std::sin(angle), 0, -std::cos(angle));
            const int times = is_rough(m) ? 1024 : 1;
            double passed = 0;
            for (int n = 0; n < times; ++n)
                passed += passes_coat(m, flat, d, random);
            sum += passed / times * std::sin(2 * angle);
        }
        mean_passed_ = sum * std::numbers::pi / 2 / steps;
        thrown_back_ = 1 - mean_passed_ / (m.index_of_refraction * m.index_of_refraction);
    }

    /// The radiance that leaves the surface for an irradiance of pi that passed the coat, before the coat's share: what
    /// leaves of it is thrown back by the coat and scattered again, any number of times.
    dvec3 reflectance(const dvec3& base) const
    {
        return base * (1 - thrown_back_) / (1.0 - base * thrown_back_) / mean_passed_;
    }

private:
    double mean_passed_ = 1, thrown_back_ = 0;
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
