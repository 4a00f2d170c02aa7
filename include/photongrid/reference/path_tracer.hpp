// Path tracing from the camera, with a shadow ray to a light at every diffuse surface.
#pragma once

#include <photongrid/reference/rough_bins.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// Estimates radiance along rays. Each call is one sample.
class path_tracer {
public:
    /// The arguments must outlive the tracer.
    path_tracer(const scene& s, const geometry& shapes, const caustic_bins& caustics, const rough_bins& on_rough,
        const reference_settings& settings)
        : bases_(s.materials.begin(), s.materials.end()), shapes_(shapes), surfaces_(s, shapes), caustics_(caustics),
          on_rough_(on_rough), settings_(settings)
    {
    }

    /// An unbiased estimate of the radiance that arrives along r, W/(m^2 sr), with caustics from group `group`.
    dvec3 radiance(ray r, random_stream& random, std::uint32_t group) const
    {
        dvec3 sum(0), throughput(1);
        std::uint32_t specular_before = 0; // specular surfaces before the first diffuse one
        std::uint32_t surfaces = 0;        // surfaces from the first diffuse one on
        bool through_specular = false;     // whether a specular surface followed the last diffuse one
        double density = 0;                // of the ray's direction at the last diffuse surface
        double come = 0;                   // from the last surface on, through clear ones, m
        auto media = surfaces_.media_at(r.origin);
        const auto is_too_deep
            = [&] { return surfaces == 0 ? ++specular_before > settings_.depth : ++surfaces > settings_.photon_depth; };
        for (;;) {
            const hit h = shapes_.nearest(r);
            throughput *= media.left_after(h.shape == nothing ? std::numeric_limits<double>::max() : h.t);
            if (h.shape == nothing || h.light != nothing) {
                const auto light = light_at(h, r.direction, come + h.t);
                if (!(light.density > 0))
                    return sum;
                double share = 1;
                if (surfaces > 0 && through_specular) // a caustic
                    share = settings_.area_light_caustics == caustics_by::paths ? 1 : 0;
                else if (surfaces > 0) // a shadow ray could have sampled it too: balance heuristic (Veach 1997)
                    share = density / (density + light.density);
                return sum + share * throughput * light.radiance;
            }
            if (surfaces_.passes(h, random)) {
                if (is_too_deep())
                    return sum;
                come += h.t;
                r = {h.position, r.direction, h.shape};
                continue;
            }
            const double before = std::exchange(come, 0);
            auto met = surfaces_.met(h, random);
            if (!media.meets(met, !(glm::dot(h.normal, r.direction) > 0))) {
                if (is_too_deep())
                    return sum;
                come = before + h.t;
                r = {h.position, r.direction, h.shape};
                continue;
            }
            const auto& m = met.of();
            specular_bounce bounce;
            if (is_coated(m))
                bounce = off_coat(m, h, r.direction, random, false);
            if (is_coated(m) && is_rough(m) && surfaces == 0 && specular_before < settings_.depth)
                sum += throughput
                    * (highlight(met, h, r.direction, media, random)
                        + on_rough_.radiance(met, h, r.direction, random, group));
            const bool by_coat = is_coated(m) && random() < bounce.weight;
            if (is_diffuse(m) && !by_coat) {
                if (++surfaces > settings_.photon_depth)
                    return sum;
                const facing_normals normals(h, r.direction);
                throughput *= bases_[met.number()].reflectance(met.reflectance());
                sum += throughput / M_PI
                    * (caustics_.irradiance(h, r.direction, group) + direct(m, h, normals, media, random));
                if (surfaces >= 3) { // Russian roulette
                    const double survival = std::min(1.0, std::max({throughput.x, throughput.y, throughput.z}));
                    if (!(random() < survival))
                        return sum;
                    throughput /= survival;
                }
                const double u = random(), v = random();
                r = {h.position, cosine_direction(normals.shading, u, v), h.shape};
                density = glm::dot(r.direction, normals.shading) / M_PI;
                if (!(density > 0) || !(glm::dot(r.direction, normals.geometric) > 0))
                    return sum;
                throughput *= passes_coat(m, h, -r.direction, random);
                through_specular = false;
            } else {
                if (is_too_deep())
                    return sum;
                if (!by_coat) {
                    if (is_rough(m) && surfaces == 0)
                        sum += throughput * met.reflectance()
                            * (highlight(met, h, r.direction, media, random)
                                + on_rough_.radiance(met, h, r.direction, random, group));
                    bounce = met.bounce(h, r.direction, random);
                    if (bounce.refracted)
                        media.pass(met);
                    throughput *= tint(met, bounce) * bounce.tint * (bounce.radiance_scale * bounce.weight);
                }
                if (!by_coat && goes_straight_on(m, bounce)) {
                    come = before + h.t;
                    r = {h.position, r.direction, h.shape};
                    continue;
                }
                r = {h.position, bounce.direction, h.shape};
                through_specular = true;
            }
            if (throughput == dvec3(0))
                return sum;
        }
    }

private:
    struct found_light {
        dvec3 radiance{0};  ///< W/(m^2 sr)
        double density = 0; ///< of shadow rays in this direction, per sr; 0: no light
    };
    /// The light on which a ray ends; `t`: how far it is from the last surface that is not clear.
    found_light light_at(const hit& h, const dvec3& d, double t) const
    {
        if (h.shape == nothing) {
            const auto* sky = shapes_.sky();
            if (sky == nullptr)
                return {};
            const auto s = sky->sky->at(d);
            return {s.radiance, sky->probability * s.density};
        }
        const auto& light = shapes_.lights()[h.light];
        const double cosine = -glm::dot(h.normal, d);
        if (!(cosine > 0))
            return {};
        return {light.radiance(), light.probability * t * t / (light.area * cosine)};
    }

    /// The radiance of lights that rays cannot find, as a rough surface reflects or refracts it against d.
    dvec3 highlight(
        const met_material& met, const hit& h, const dvec3& d, const path_media& media, random_stream& random) const
    {
        const auto& light = chosen_of(shapes_.lights(), random);
        if (light.is_visible())
            return dvec3(0);
        const auto seen = shapes_.seen_from(light, h.position, random);
        const dvec3 reflected
            = met.bsdf(h, d, seen.towards) * std::abs(glm::dot(seen.towards, facing_normals(h, d).shading));
        if (reflected == dvec3(0) || seen.arriving == dvec3(0))
            return dvec3(0);
        const dvec3 passes = surfaces_.share_through({h.position, seen.towards, h.shape}, seen.distance, seen.shape)
            * media.left_after(seen.distance);
        return seen.arriving * reflected * passes / light.probability;
    }

    /// The irradiance of direct light, below a coat if there is one, by one shadow ray to a light chosen by power.
    dvec3 direct(const material& m, const hit& h, const facing_normals& normals, const path_media& media,
        random_stream& random) const
    {
        const auto& light = chosen_of(shapes_.lights(), random);
        const auto seen = shapes_.seen_from(light, h.position, random);
        const dvec3& d = seen.towards;
        double cosine = glm::dot(normals.geometric, d) > 0 ? glm::dot(normals.shading, d) : 0;
        const double by_surface = cosine / M_PI;
        if (cosine > 0)
            cosine *= passes_coat(m, h, -d, random);
        if (!(cosine > 0) || seen.arriving == dvec3(0))
            return dvec3(0);
        const dvec3 passing = seen.arriving
            * surfaces_.share_through({h.position, d, h.shape}, seen.distance, seen.shape)
            * media.left_after(seen.distance);
        if (!(seen.density > 0))
            return passing * (cosine / light.probability);
        const double by_light = light.probability * seen.density;
        return passing * (cosine / (by_light + by_surface));
    }

    std::vector<diffuse_base> bases_; ///< by material
    const geometry& shapes_;
    surfaces surfaces_;
    const caustic_bins& caustics_;
    const rough_bins& on_rough_;
    const reference_settings& settings_;
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
