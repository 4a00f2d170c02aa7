// Light on rough surfaces that eye paths cannot find: of lights that no ray hits, by smooth mirrors and glass, which
// block shadow rays. Light paths that end on rough surfaces are kept in bins, with their directions.
#pragma once

#include <photongrid/reference/light_tracer.hpp>

#include <algorithm>
#include <numeric>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// The ends of light paths on rough surfaces, after smooth ones and none but those.
class rough_bins {
public:
    /// No bins.
    rough_bins() = default;
    /// There are none if no light needs them, or nothing is smooth, or nothing is rough.
    /// \throws std::invalid_argument for too many bins, render_cancelled.
    rough_bins(const scene& s, const geometry& shapes, const reference_settings& settings,
        const render_observer& observer, reference_stats& stats)
        : materials_(&s.materials)
    {
        const bool is_smooth = any_surface(s, [](const material& m) {
            return (!is_diffuse(m) || is_coated(m)) && (!is_rough(m) || m.roughness_texture.map);
        });
        for (const auto& l : shapes.lights())
            if (!l.is_visible())
                lights_.push_back(l);
        if (!is_smooth || lights_.empty())
            return;
        share_probabilities(lights_);
        bins_ = {s, shapes, settings, [&](const material& m) { return is_rough_in_part(m); }};
        if (bins_.size() == 0)
            return;
        areas_ = bins_.areas();
        paths_per_group_ = (settings.paths + light_groups - 1) / light_groups;
        stats.bins += bins_.size();
        stats.bin_size = std::max(stats.bin_size, bins_.edge());
        stats.light_paths += paths_per_group_ * light_groups;
        groups_.resize(light_groups);
        const surfaces met(s, shapes);
        share_out(light_groups, threads_for(settings.threads), "light_paths",
            static_cast<double>(paths_per_group_ * light_groups), observer,
            [&](std::uint32_t group, watch& w) { trace_group(met, shapes, settings, group, w); });
    }

    bool empty() const { return groups_.empty(); }

    /// An estimate of the radiance that a ray of direction d sees of it at `h`, with the material `met` there, divided
    /// by the reflectance.
    dvec3 radiance(
        const met_material& met, const hit& h, const dvec3& d, random_stream& random, std::uint32_t group) const
    {
        dvec3 sum(0);
        if (empty() || !bins_.has(h))
            return sum;
        const auto& g = groups_[group];
        const std::uint32_t own = bins_.at(h, d);
        for (const std::uint32_t bin : {own, own ^ 1u}) { // either side
            const std::size_t n = g.first[bin + 1] - g.first[bin];
            if (n == 0 || !(areas_[bin] > 0))
                continue;
            const auto& end = g.ends[g.first[bin] + std::min(n - 1, static_cast<std::size_t>(random() * double(n)))];
            const double per_power = static_cast<double>(n) / (areas_[bin] * static_cast<double>(paths_per_group_));
            sum += dvec3(end.power) * (per_power * met.bsdf(h, d, -glm::normalize(dvec3(end.direction))));
        }
        return sum;
    }

private:
    struct path_end {
        std::uint32_t bin;
        glm::vec3 direction, power;
    };
    struct group_ends {
        std::vector<path_end> ends;     ///< by bin
        std::vector<std::size_t> first; ///< of each bin, and of one more
    };

    bool is_rough_in_part(const material& m) const
    {
        const auto parts = parts_of(*materials_, m);
        return std::any_of(parts.begin(), parts.end(), [](const material* part) { return is_rough(*part); });
    }

    void trace_group(
        const surfaces& met, const geometry& shapes, const reference_settings& settings, std::uint32_t group, watch& w)
    {
        std::vector<path_end> found;
        random_stream random(settings.seed, 3, group);
        constexpr std::uint64_t paths_per_report = 1024;
        for (std::uint64_t done = 0; done < paths_per_group_;) {
            const std::uint64_t past = std::min(paths_per_group_, done + paths_per_report);
            if (!w.goes_on(past - done))
                return;
            for (; done < past; ++done)
                trace_path(met, shapes, settings, random, found);
        }
        auto& g = groups_[group];
        g.first.assign(bins_.size() + std::size_t{1}, 0);
        for (const auto& e : found)
            ++g.first[e.bin + 1];
        std::partial_sum(g.first.begin(), g.first.end(), g.first.begin());
        std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.bin < b.bin; });
        g.ends = std::move(found);
    }

    /// Traces one path from smooth surface to smooth surface, and adds its ends on rough ones.
    void trace_path(const surfaces& all, const geometry& shapes, const reference_settings& settings,
        random_stream& random, std::vector<path_end>& found) const
    {
        const auto& light = chosen_of(lights_, random);
        const auto emitted = shapes.emit(light, random);
        dvec3 power = emitted.power / light.probability;
        ray r = emitted.from;
        auto media = all.media_at(r.origin);
        bool from_light = true; // straight, or through clear surfaces
        for (std::uint32_t surface = 1; surface <= settings.photon_depth; ++surface) {
            const hit h = shapes.nearest(r);
            if (h.shape == nothing || h.light != nothing)
                return;
            power *= media.left_after(h.t);
            if (!from_light && is_rough_in_part((*materials_)[h.material]))
                found.push_back({bins_.at(h, r.direction), glm::vec3(r.direction),
                    glm::vec3(power * facing_normals(h, r.direction).received(r.direction))});
            if (all.passes(h, random)) {
                r = {h.position, r.direction, h.shape};
                continue;
            }
            auto met = all.met(h, random);
            if (!media.meets(met, !(glm::dot(h.normal, r.direction) > 0))) {
                r = {h.position, r.direction, h.shape};
                continue;
            }
            const auto& m = met.of();
            if (is_rough(m) || (is_diffuse(m) && !is_coated(m)))
                return;
            const auto bounce = is_coated(m) ? off_coat(m, h, r.direction, random, true)
                                             : specular_of_light(m, h, r.direction, random);
            if (bounce.adjoint == 0 || bounce.weight == 0)
                return;
            from_light = from_light && goes_straight_on(m, bounce);
            power *= (is_coated(m) ? dvec3(1) : tint(met, bounce)) * (bounce.adjoint * bounce.weight);
            if (bounce.refracted)
                media.pass(met);
            r = {h.position, bounce.direction, h.shape};
        }
    }

    const std::vector<material>* materials_ = nullptr;
    std::vector<light_source> lights_;
    binned_surfaces bins_;
    std::vector<double> areas_; ///< of the bins, m^2
    std::uint64_t paths_per_group_ = 0;
    std::vector<group_ends> groups_;
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
