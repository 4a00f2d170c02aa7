// Caustics by brute force: traces light paths from the lights through mirrors and glass to the first diffuse surface,
// and sums their power in bins. A path tracer cannot find caustics of point lights, because no eye path hits a point
// light.
#pragma once

#include <photongrid/reference/binned_surfaces.hpp>
#include <photongrid/reference/coat.hpp>
#include <photongrid/reference/intersect.hpp>
#include <photongrid/reference/random_stream.hpp>
#include <photongrid/reference/settings.hpp>
#include <photongrid/reference/surfaces.hpp>
#include <photongrid/reference/work.hpp>

#include <span>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// The number of groups of light paths. Each has its own bins, so the groups are independent and the spread between
/// them measures the error. One thread traces a group, in path order, so sums do not depend on the number of threads.
constexpr std::uint32_t light_groups = 16;

/// Gives lights probabilities proportional to their power.
inline void share_probabilities(std::vector<light_source>& lights)
{
    const auto brightness = [](const light_source& l) { return l.power.x + l.power.y + l.power.z; };
    double total = 0;
    for (const auto& l : lights)
        total += brightness(l);
    for (auto& l : lights)
        l.probability = brightness(l) / total;
}
/// One of some lights, by these probabilities.
inline const light_source& chosen_of(std::span<const light_source> lights, random_stream& random)
{
    const auto* light = &lights.front();
    if (lights.size() > 1) {
        double u = random();
        for (const auto& l : lights) {
            light = &l;
            if ((u -= l.probability) < 0)
                break;
        }
    }
    return *light;
}

/// The caustic irradiance of diffuse surfaces: light that came from a light by mirrors and glass only, at least one of
/// them.
class caustic_bins {
public:
    /// No bins.
    caustic_bins() = default;

    /// There are no bins if no light needs them or the scene has no caustics.
    /// \throws std::invalid_argument for too many bins, render_cancelled.
    caustic_bins(const scene& s, const geometry& shapes, const reference_settings& settings,
        const render_observer& observer, reference_stats& stats)
    {
        lights_.reserve(shapes.lights().size());
        for (const auto& l : shapes.lights())
            if (!l.is_visible() || settings.area_light_caustics == caustics_by::bins)
                lights_.push_back(l);
        if (lights_.empty())
            return;
        paths_per_group_ = (settings.paths + light_groups - 1) / light_groups;
        if (any_surface(s, [](const material& m) { return !is_diffuse(m) || is_coated(m); }))
            bins_ = {s, shapes, settings, [&](const material& m) { return is_diffuse(s.materials, m); }};
        if (bins_.size() == 0)
            return;
        areas_ = bins_.areas();
        stats.bins = bins_.size();
        stats.bin_size = bins_.edge();
        stats.light_paths = paths_per_group_ * light_groups;
        share_probabilities(lights_);
        irradiance_.resize(light_groups);
        std::vector<std::uint64_t> hits(light_groups, 0);
        const surfaces met(s, shapes);
        share_out(light_groups, threads_for(settings.threads), "light_paths", static_cast<double>(stats.light_paths),
            observer,
            [&](std::uint32_t group, watch& w) { hits[group] = trace_group(met, shapes, settings, group, w); });
        for (const auto h : hits)
            stats.caustic_hits += h;
    }

    /// Whether there are no bins: nothing is specular, nothing is diffuse, or eye paths find the caustics of all
    /// lights.
    bool empty() const { return irradiance_.empty(); }

    /// The irradiance at `h` on the side that a ray of direction d hits, W/m^2, from group `group`.
    dvec3 irradiance(const hit& h, const dvec3& d, std::uint32_t group) const
    {
        if (empty())
            return dvec3(0);
        return dvec3(irradiance_[group][bins_.at(h, d)]);
    }

    /// The mean over all groups and its standard error.
    std::pair<dvec3, dvec3> irradiance(const hit& h, const dvec3& d) const
    {
        dvec3 sum(0), squares(0);
        for (std::uint32_t g = 0; g < light_groups; ++g)
            sum += irradiance(h, d, g);
        const dvec3 mean = sum / double{light_groups};
        for (std::uint32_t g = 0; g < light_groups; ++g)
            squares += (irradiance(h, d, g) - mean) * (irradiance(h, d, g) - mean);
        return {mean, glm::sqrt(squares / (light_groups * (light_groups - 1.0)))};
    }

private:
    std::uint64_t trace_group(
        const surfaces& met, const geometry& shapes, const reference_settings& settings, std::uint32_t group, watch& w)
    {
        std::vector<dvec3> flux(bins_.size(), dvec3(0));
        random_stream random(settings.seed, 1, group);
        std::uint64_t hits = 0;
        constexpr std::uint64_t paths_per_report = 1024;
        for (std::uint64_t done = 0; done < paths_per_group_;) {
            const std::uint64_t past = std::min(paths_per_group_, done + paths_per_report);
            if (!w.goes_on(past - done))
                return hits;
            for (; done < past; ++done)
                hits += trace_path(met, shapes, settings, random, flux);
        }
        auto& out = irradiance_[group];
        out.assign(bins_.size(), glm::vec3(0));
        for (std::uint32_t i = 0; i < bins_.size(); ++i)
            if (areas_[i] > 0)
                out[i] = glm::vec3(flux[i] / (areas_[i] * static_cast<double>(paths_per_group_)));
        return hits;
    }

    /// Traces one path up to its first diffuse surface, and on from there if a coat or another part of a mixture
    /// reflects it. Returns how often it added to a bin.
    std::uint64_t trace_path(const surfaces& all, const geometry& shapes, const reference_settings& settings,
        random_stream& random, std::vector<dvec3>& flux) const
    {
        const auto& light = chosen_of(lights_, random);
        const auto emitted = shapes.emit(light, random);
        dvec3 power = emitted.power / light.probability;
        ray r = emitted.from;
        auto media = all.media_at(r.origin);
        std::uint64_t added = 0;
        bool from_light = true; // straight, or through clear surfaces
        for (std::uint32_t surface = 1; surface <= settings.photon_depth; ++surface) {
            const hit h = shapes.nearest(r);
            if (h.shape == nothing || h.light != nothing)
                return added;
            power *= media.left_after(h.t);
            // What is clear in part receives all light: the eye sees that share of it which is its opacity.
            const bool passes = all.passes(h, random);
            if (passes && from_light) {
                r = {h.position, r.direction, h.shape};
                continue;
            }
            auto met = all.met(h, random);
            if (!media.meets(met, !(glm::dot(h.normal, r.direction) > 0))) {
                r = {h.position, r.direction, h.shape};
                continue;
            }
            const auto& m = met.of();
            const auto bounce = is_coated(m) ? off_coat(m, h, r.direction, random, true)
                : is_diffuse(m)              ? specular_bounce{.weight = 0}
                                             : met.bounce_of_light(h, r.direction, random);
            if (const auto* base = from_light ? nullptr : all.base(h)) { // else direct light: see the path tracer
                const double passed = is_diffuse(m) ? 1 - bounce.weight : passes_coat(*base, h, r.direction, random);
                flux[bins_.at(h, r.direction)] += power * passed * facing_normals(h, r.direction).received(r.direction);
                ++added;
            }
            if (passes) {
                r = {h.position, r.direction, h.shape};
                continue;
            }
            if (bounce.adjoint == 0 || bounce.weight == 0)
                return added;
            from_light = from_light && goes_straight_on(m, bounce);
            power *= (is_coated(m) ? dvec3(1) : tint(met, bounce)) * bounce.tint * (bounce.adjoint * bounce.weight);
            if (bounce.refracted)
                media.pass(met);
            r = {h.position, bounce.direction, h.shape};
        }
        return added;
    }

    std::vector<light_source> lights_;
    binned_surfaces bins_;      ///< of all diffuse surfaces
    std::vector<double> areas_; ///< of the bins, m^2
    std::uint64_t paths_per_group_ = 0;
    std::vector<std::vector<glm::vec3>> irradiance_; ///< by group and bin
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
