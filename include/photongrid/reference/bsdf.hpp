// Scattering of light at surfaces, for the reference renderer, with the conventions of the photon-map renderer
// (docs/reference/reference_renderer.md).
#pragma once

#include <photongrid/reference/directions.hpp>
#include <photongrid/reference/intersect.hpp>
#include <photongrid/reference/random_stream.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// Fresnel's reflectance of a smooth surface between two dielectrics, for unpolarised light.
inline double fresnel_reflectance(double cos_i, double n_i, double cos_t, double n_t)
{
    const double s = (n_i * cos_i - n_t * cos_t) / (n_i * cos_i + n_t * cos_t);
    const double p = (n_i * cos_t - n_t * cos_i) / (n_i * cos_t + n_t * cos_i);
    return 0.5 * (s * s + p * p);
}

/// The share of light that a pane reflects, of one that meets it at this cosine: with all reflections between its
/// faces.
inline double pane_reflectance(const material& m, double cosine)
{
    const double n = m.index_of_refraction, sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)) / n,
                 face = fresnel_reflectance(std::min(1.0, cosine), 1, std::sqrt(1 - sine * sine), n);
    double all = face, inside = (1 - face) * (1 - face) * face; // off the first face; off the second one, and out
    for (int turn = 0; turn < 1000 && inside > 1e-18; ++turn) {
        all += inside;
        inside *= face * face;
    }
    return all;
}

/// A ray's continuation from a specular surface.
struct specular_bounce {
    dvec3 direction{0, 0, 1}; ///< unit
    /// The factor for radiance along a ray that is traced from the eye: (n of the side it comes from / n of the side it
    /// goes to)^2 at refraction, because radiance / n^2 is constant; 1 at reflection. Power traced from the lights is
    /// not scaled.
    double radiance_scale = 1;
    bool refracted = false;
    /// The factor for power that is traced from the lights: Veach's correction for shading normals (1997, section 5.3),
    /// at most 8.
    double adjoint = 1;
    double weight = 1; ///< the share that is not lost on rough surfaces, divided by its probability
    dvec3 tint{1};     ///< factor on the reflectance
};

/// At a refracting surface, `u` in [0, 1) selects reflection with Fresnel's probability. The caller applies the
/// material's colour.
inline specular_bounce specular(const material& m, const dvec3& d, const dvec3& normal, double u)
{
    const double d_dot_n = glm::dot(d, normal);
    const specular_bounce reflected{glm::normalize(d - 2 * d_dot_n * normal)};
    if (is_thin(m)) {
        const bool passes = !(u < pane_reflectance(m, std::abs(d_dot_n)));
        return passes ? specular_bounce{d, 1, true} : reflected;
    }
    if (!refracts(m))
        return reflected;
    const bool entering = d_dot_n < 0;
    const double n_i = entering ? 1 : m.index_of_refraction, n_t = entering ? m.index_of_refraction : 1;
    const double cos_i = std::min(1.0, std::abs(d_dot_n));
    const double sin_t = n_i / n_t * std::sqrt(std::max(0.0, 1 - cos_i * cos_i)); // Snell
    if (sin_t >= 1)
        return reflected; // total internal reflection
    const double cos_t = std::sqrt(1 - sin_t * sin_t);
    if (u < fresnel_reflectance(cos_i, n_i, cos_t, n_t))
        return reflected;
    const dvec3 into = entering ? -normal : normal;
    const dvec3 sideways = d - cos_i * into; // of length sin_i
    return {glm::normalize(n_i / n_t * sideways + cos_t * into), n_i * n_i / (n_t * n_t), true};
}

/// The normals at a hit on the side of a ray of direction d. As in the photon-map renderer the shading normal is turned
/// towards the ray where their cosine is below 2^-7.
struct facing_normals {
    dvec3 geometric, shading;

    facing_normals(const hit& h, const dvec3& d)
    {
        const double side = glm::dot(h.normal, d) > 0 ? -1 : 1, least = 0x1p-7;
        geometric = side * h.normal;
        shading = side * h.shading;
        if (const double cosine = -glm::dot(shading, d); cosine < least && h.shading != h.normal)
            shading = glm::normalize(shading - (least - cosine) * d);
    }

    /// The factor on power that the surface receives along d, which its geometric normal has measured; at most 8.
    double received(const dvec3& d) const { return std::min(8.0, glm::dot(shading, d) / glm::dot(geometric, d)); }
};

/// Smith's share of the facets of GGX that no other facet hides; `cosine`: of the direction and the normal.
inline double unhidden(double cosine, double alpha)
{
    const double tangent2 = (1 - cosine * cosine) / (cosine * cosine);
    return 2 / (1 + std::sqrt(1 + alpha * alpha * std::max(0.0, tangent2)));
}

/// A bounce from a facet of a rough surface (Walter et al. 2007). Normals of facets are drawn by their density,
/// not by what is seen of them as in the photon-map renderer: weights may be far above 1.
inline specular_bounce rough(const material& m, const hit& h, const dvec3& d, random_stream& random)
{
    const double alpha = m.roughness * m.roughness;
    const facing_normals n(h, d);
    const double side = glm::dot(h.normal, d) > 0 ? -1 : 1, u = random(), turn = random();
    const double tangent2 = alpha * alpha * u / (1 - u), cosine = 1 / std::sqrt(1 + tangent2);
    const dvec3 facet = around(n.shading, cosine, 2 * std::numbers::pi * turn);
    const double met = -glm::dot(d, facet), seen = -glm::dot(d, n.shading);
    specular_bounce lost;
    lost.weight = 0;
    if (!(met > 0))
        return lost;
    auto bounce = specular(m, d, side * facet, refracts(m) || is_thin(m) ? random() : 0);
    if (is_thin(m) && bounce.refracted) { // as what is reflected, on the other side
        const dvec3 reflected = d + 2 * met * facet;
        bounce.direction = reflected - 2 * glm::dot(reflected, n.shading) * n.shading;
    }
    const double up = bounce.refracted ? -1 : 1, leaving = up * glm::dot(bounce.direction, n.shading),
                 geometric = up * glm::dot(bounce.direction, n.geometric);
    if (!(leaving > 0) || !(geometric > 0))
        return lost;
    bounce.weight = met * unhidden(seen, alpha) * unhidden(leaving, alpha) / (seen * cosine);
    bounce.adjoint = std::min(8.0, std::abs(glm::dot(d, n.shading) * geometric / (glm::dot(d, n.geometric) * leaving)));
    return bounce;
}

/// The BSDF of a rough surface, or of a rough coat, for radiance that comes from `towards` and leaves against d, per
/// sr.
inline double rough_bsdf(const material& m, const hit& h, const dvec3& d, const dvec3& towards)
{
    const facing_normals n(h, d);
    const double in = glm::dot(towards, n.shading), out = -glm::dot(d, n.shading);
    if (in * glm::dot(towards, n.geometric) <= 0 || (in < 0 && !refracts(m) && !is_thin(m)))
        return 0;
    if (is_thin(m)) {
        const dvec3 other = in > 0 ? towards : towards - 2 * in * n.shading, facet = glm::normalize(other - d);
        const double met = -glm::dot(d, facet), cosine = glm::dot(facet, n.shading), alpha = m.roughness * m.roughness;
        if (!(met > 0) || !(cosine > 0))
            return 0;
        const double spread = cosine * cosine * (alpha * alpha - 1) + 1, reflected = pane_reflectance(m, met);
        return (in > 0 ? reflected : 1 - reflected) * alpha * alpha / (std::numbers::pi * spread * spread)
            * unhidden(std::abs(in), alpha) * unhidden(out, alpha) / (4 * std::abs(in) * out);
    }
    const bool outside = is_coated(m) || !(glm::dot(h.normal, d) > 0); // a coat is on both sides
    const double n_out = outside ? 1 : m.index_of_refraction, n_far = outside ? m.index_of_refraction : 1,
                 n_in = in > 0 ? n_out : n_far;
    dvec3 facet = glm::normalize(n_in * towards - n_out * d);
    if (glm::dot(facet, n.shading) < 0)
        facet = -facet;
    const double met = -glm::dot(d, facet), lit = glm::dot(towards, facet), cosine = glm::dot(facet, n.shading);
    if (!(met > 0) || !(lit * in > 0))
        return 0;
    double reflected = 1;
    if (refracts(m) || is_coated(m)) {
        const double sine = n_out / n_far * std::sqrt(std::max(0.0, 1 - met * met));
        if (sine < 1)
            reflected = fresnel_reflectance(met, n_out, std::sqrt(1 - sine * sine), n_far);
    }
    const double alpha = m.roughness * m.roughness, spread = cosine * cosine * (alpha * alpha - 1) + 1;
    const double facets
        = alpha * alpha / (std::numbers::pi * spread * spread) * unhidden(std::abs(in), alpha) * unhidden(out, alpha);
    if (in > 0)
        return reflected * facets / (4 * in * out);
    const double apart = n_out * met + n_in * lit;
    return (1 - reflected) * facets * met * std::abs(lit / (in * out)) * n_out * n_out / (apart * apart);
}

/// The same at a hit, by its shading normal, or by the geometric one where that would lead to the wrong side; with a
/// number from `random` where the surface needs one.
inline specular_bounce specular(const material& m, const hit& h, const dvec3& d, random_stream& random)
{
    if (is_rough(m))
        return rough(m, h, d, random);
    const double u = refracts(m) || is_thin(m) ? random() : 0;
    if (h.shading == h.normal)
        return specular(m, d, h.normal, u);
    const facing_normals n(h, d);
    auto bounce = specular(m, d, glm::dot(h.normal, d) > 0 ? -n.shading : n.shading, u);
    if (is_thin(m) && bounce.refracted)
        return bounce;
    const double side = glm::dot(bounce.direction, n.geometric);
    if (bounce.refracted ? side < 0 : side > 0) {
        bounce.adjoint = std::min(8.0,
            std::abs(
                glm::dot(d, n.shading) * side / (glm::dot(d, n.geometric) * glm::dot(bounce.direction, n.shading))));
        return bounce;
    }
    return specular(m, d, h.normal, bounce.refracted ? 1 : -1); // of the same kind, or reflected totally
}

/// The same for power from a light. A reflection goes where an eye ray that takes it backwards comes from: by the
/// shading normal, by the geometric one, by either at random with twice the power, or nowhere (adjoint 0).
inline specular_bounce specular_of_light(const material& m, const hit& h, const dvec3& d, random_stream& random)
{
    auto bounce = specular(m, h, d, random);
    if (bounce.refracted || h.shading == h.normal || is_rough(m))
        return bounce;
    const facing_normals n(h, d);
    const auto mirrored = [](const dvec3& v, const dvec3& normal) { return v - 2 * glm::dot(v, normal) * normal; };
    const dvec3 other = mirrored(d, n.geometric);
    const bool by_shading = glm::dot(mirrored(d, n.shading), n.geometric) > 0,
               by_geometric = !(glm::dot(mirrored(-other, n.shading), n.geometric) > 0);
    if (by_shading && by_geometric && random() < 0.5)
        return {glm::normalize(other), 1, false, 2};
    bounce.adjoint *= by_shading && by_geometric ? 2 : by_shading || by_geometric ? 1 : 0;
    return bounce;
}

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
