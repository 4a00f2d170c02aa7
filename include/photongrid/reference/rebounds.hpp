// Light that meets several facets of rough metal or glass before it leaves, for the reference renderer
// (docs/reference/reference_renderer.md). It has its own tables and shares none with the photon-map renderer.
#pragma once

#include <photongrid/reference/coat.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// What facets hide of light from a cosine, and how it leaves at last (Kulla and Conty 2017).
class facet_rebounds {
public:
    /// Of a material with rebounds, for its roughness and less.
    explicit facet_rebounds(const material& m)
        : glass_(refracts(m)), index_(glass_ ? m.index_of_refraction : 1), most_(m.roughness)
    {
        const int count = m.roughness_texture.map ? textured_rows : 1;
        double reflected = 0;
        for (int n = 0; n < 1024; ++n)
            if (const double cosine = (n + 0.5) / 1024; glass_)
                reflected += coat_reflectance(cosine, index_) * 2 * cosine / 1024;
        for (int n = 0; n < count; ++n)
            rows_.push_back(row_of(m, count == 1 ? most_ : most_ * std::max(0.25, double(n)) / (count - 1), reflected));
    }

    /// The factor on the reflectance r: of metal, r E / (1 - r (1 - E)), E: the mean share that is not hidden.
    dvec3 tint(double roughness, const dvec3& reflectance) const
    {
        const double hidden = mean(roughness, false);
        return glass_ ? dvec3(1) : reflectance * (1 - hidden) / (1.0 - reflectance * hidden);
    }

    /// The share of light from this cosine that is hidden.
    double hidden(double roughness, bool inside, double cosine) const
    {
        const double spread = 2 * roughness * roughness,
                     at = std::min(double{steps}, cosine / (cosine + spread) * (1 + spread) * steps);
        const auto step = std::min(steps - 1, static_cast<int>(at));
        const double a = cosine_of(step, spread), b = cosine_of(step + 1, spread), t = (cosine - a) / (b - a);
        return between(roughness, [&](const row& r) {
            const auto& h = r.hidden[inside ? 1 : 0];
            return h[static_cast<std::size_t>(step)] * (1 - t) + h[static_cast<std::size_t>(step) + 1] * t;
        });
    }

    /// The mean of that over light that comes evenly.
    double mean(double roughness, bool inside) const
    {
        const double alpha = roughness * roughness;
        return alpha * alpha * between(roughness, [&](const row& r) { return r.mean_per_alpha2[inside ? 1 : 0]; });
    }

    /// Of the light that is hidden on one side, the share that leaves on the other.
    double crosses(double roughness, bool inside) const
    {
        const double outside = between(roughness, [](const row& r) { return r.crosses; });
        return inside ? outside * mean(roughness, false) / (index_ * index_ * mean(roughness, true)) : outside;
    }

    /// The density of power, per sr and per cosine of the direction in which it leaves, of light that comes from the
    /// cosine `from` on one side and leaves at the cosine `to`.
    double scattered(double roughness, bool inside, double from, double to, bool across) const
    {
        const double crossing = crosses(roughness, inside);
        const bool ends_inside = inside != across;
        return (across ? crossing : 1 - crossing) * hidden(roughness, inside, from) * hidden(roughness, ends_inside, to)
            / (std::numbers::pi * mean(roughness, ends_inside));
    }

private:
    static constexpr int steps = 32, textured_rows = 17;
    struct row {
        std::array<std::array<double, steps + 1>, 2> hidden{}; ///< outside and inside, by the cosine
        std::array<double, 2> mean_per_alpha2{};
        double crosses = 0;
    };

    /// Cosines are denser towards grazing angles.
    static double cosine_of(int step, double spread)
    {
        return std::min(1.0, spread * step / (steps * (1 + spread) - step));
    }

    row row_of(material m, double roughness, double reflected_once_more) const
    {
        m.roughness = roughness;
        const double alpha = roughness * roughness, spread = 2 * alpha;
        row r;
        std::array<double, 2> reflected{};
        std::array<std::array<double, steps + 1>, 2> of_reflected{};
        for (const int inside : {0, 1}) {
            if (inside == 1 && !glass_)
                continue;
            auto& h = r.hidden[static_cast<std::size_t>(inside)];
            auto& hr = of_reflected[static_cast<std::size_t>(inside)];
            for (int n = 0; n <= steps; ++n) {
                const auto [mirrored, all] = hidden_light(m, std::max(1e-9, cosine_of(n, spread)), inside == 1);
                h[static_cast<std::size_t>(n)] = all;
                hr[static_cast<std::size_t>(n)] = mirrored;
            }
            const auto mean_of = [&](const auto& shares) {
                double sum = 0;
                for (int n = 0; n < steps; ++n) { // Simpson's rule is exact: a line times the cosine
                    const auto at = static_cast<std::size_t>(n);
                    const double a = cosine_of(n, spread), b = cosine_of(n + 1, spread);
                    sum += (b - a) / 6
                        * (shares[at] * 2 * a + 4 * (shares[at] + shares[at + 1]) / 2 * (a + b)
                            + shares[at + 1] * 2 * b);
                }
                return sum;
            };
            r.mean_per_alpha2[static_cast<std::size_t>(inside)] = mean_of(h) / (alpha * alpha);
            reflected[static_cast<std::size_t>(inside)] = mean_of(hr) / (alpha * alpha);
        }
        // What is reflected, hidden, and reflected once more stays on its side.
        if (glass_)
            r.crosses = 1 - reflected_once_more * reflected[0] / r.mean_per_alpha2[0];
        return r;
    }

    /// Of light from this cosine, the shares that are hidden after a reflection, and in all.
    std::pair<double, double> hidden_light(const material& m, double cosine, bool inside) const
    {
        constexpr int facets = 2048;
        const double alpha = m.roughness * m.roughness;
        const dvec3 up(0, 0, 1), d(-std::sqrt(1 - cosine * cosine), 0, -cosine);
        double mirrored = 0, all = 0;
        for (int n = 0; n < facets; ++n) {
            const double turn = n * std::numbers::phi;
            const dvec3 facet = visible_facet(up, d, alpha, (n + 0.5) / facets, turn - std::floor(turn));
            const dvec3 outward = inside ? -facet : facet;
            const auto out = specular(m, d, outward, -1), through = specular(m, d, outward, 2);
            double share = 1; // of the reflection
            if (through.refracted) {
                const double met = std::min(1.0, -glm::dot(d, facet)),
                             beyond = std::min(1.0, -glm::dot(through.direction, facet));
                share = fresnel_reflectance(met, inside ? index_ : 1, beyond, inside ? 1 : index_);
            }
            const auto lost = [&](const dvec3& direction, double side) {
                const double leaving = side * direction.z;
                return leaving > 0 ? 1 - unhidden(std::min(1.0, leaving), alpha) : 1;
            };
            mirrored += share * lost(out.direction, 1) / facets;
            all += (1 - share) * lost(through.direction, -1) / facets;
        }
        return {mirrored, mirrored + all};
    }

    /// What rows have, between those of a roughness.
    template <class Of>
    double between(double roughness, const Of& of) const
    {
        if (rows_.size() == 1)
            return of(rows_[0]);
        const double at = roughness / most_ * double(rows_.size() - 1);
        const auto low = std::min(rows_.size() - 2, static_cast<std::size_t>(at));
        const double t = std::min(1.0, at - double(low));
        return of(rows_[low]) * (1 - t) + of(rows_[low + 1]) * t;
    }

    bool glass_;
    double index_, most_;
    std::vector<row> rows_;
};

/// A rough surface, or a coat: its BSDF for radiance that comes from `towards` and leaves against d, per sr, divided by
/// the reflectance. `rebounds`: of its material; null: none.
inline dvec3 rough_bsdf(const facet_rebounds* rebounds, const material& m, const dvec3& reflectance, const hit& h,
    const dvec3& d, const dvec3& towards)
{
    const double single = rough_bsdf(m, h, d, towards);
    const facing_normals n(h, d);
    const double in = glm::dot(towards, n.shading), out = -glm::dot(d, n.shading);
    if (rebounds == nullptr || in * glm::dot(towards, n.geometric) <= 0 || !(out > 0) || (in < 0 && !refracts(m)))
        return dvec3(single);
    const bool inside = refracts(m) && glm::dot(h.normal, d) > 0, across = in < 0;
    const double eta = inside ? m.index_of_refraction : 1 / m.index_of_refraction;
    return single
        + rebounds->tint(m.roughness, reflectance)
        * (rebounds->scattered(m.roughness, inside, out, std::abs(in), across) * (across ? eta * eta : 1));
}

/// A bounce from a rough surface of a material with rebounds: from one facet, or after several.
inline specular_bounce rough(const facet_rebounds& rebounds, const material& m, const dvec3& reflectance, const hit& h,
    const dvec3& d, random_stream& random)
{
    const facing_normals n(h, d);
    const double seen = std::clamp(-glm::dot(d, n.shading), 0.0, 1.0);
    const bool inside = refracts(m) && glm::dot(h.normal, d) > 0;
    const double hidden = rebounds.hidden(m.roughness, inside, seen);
    if (!(random() < hidden)) {
        auto bounce = rough(m, h, d, random);
        bounce.weight /= 1 - hidden;
        return bounce;
    }
    const bool across = refracts(m) && random() < rebounds.crosses(m.roughness, inside);
    const double u = random(), v = random(), up = across ? -1 : 1;
    specular_bounce bounce{cosine_direction(up * n.shading, u, v)};
    bounce.refracted = across;
    const double leaving = up * glm::dot(bounce.direction, n.shading),
                 geometric = up * glm::dot(bounce.direction, n.geometric),
                 eta = inside ? m.index_of_refraction : 1 / m.index_of_refraction;
    bounce.radiance_scale = across ? eta * eta : 1;
    bounce.tint = rebounds.tint(m.roughness, reflectance);
    bounce.weight = 0;
    if (!(leaving > 0) || !(geometric > 0))
        return bounce;
    const bool ends_inside = inside != across;
    bounce.weight = rebounds.hidden(m.roughness, ends_inside, leaving) / rebounds.mean(m.roughness, ends_inside);
    bounce.adjoint = std::min(8.0, std::abs(glm::dot(d, n.shading) * geometric / (glm::dot(d, n.geometric) * leaving)));
    return bounce;
}

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
