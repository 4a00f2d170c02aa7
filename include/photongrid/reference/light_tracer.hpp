// Caustics by brute force: traces light paths from the lights through mirrors and glass to the first diffuse surface,
// and sums their power in bins. A path tracer cannot find caustics of point lights, because no eye path hits a point
// light.
#pragma once

#include <photongrid/reference/coat.hpp>
#include <photongrid/reference/intersect.hpp>
#include <photongrid/reference/random_stream.hpp>
#include <photongrid/reference/settings.hpp>
#include <photongrid/reference/surfaces.hpp>
#include <photongrid/reference/work.hpp>

#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// The number of groups of light paths. Each has its own bins, so the groups are independent and the spread between
/// them measures the error. One thread traces a group, in path order, so sums do not depend on the number of threads.
constexpr std::uint32_t light_groups = 16;

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
        cut(s, shapes, settings);
        if (size_ == 0)
            return;
        stats.bins = size_;
        stats.bin_size = bin_;
        stats.light_paths = paths_per_group_ * light_groups;
        double total = 0;
        for (const auto& l : lights_)
            total += brightness(l);
        for (auto& l : lights_)
            l.probability = brightness(l) / total;

        irradiance_.resize(light_groups);
        std::vector<std::uint64_t> hits(light_groups, 0);
        share_out(light_groups, threads_for(settings.threads), "light_paths", static_cast<double>(stats.light_paths),
            observer, [&](std::uint32_t group, watch& w) { hits[group] = trace_group(s, shapes, settings, group, w); });
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
        return dvec3(irradiance_[group][bin_at(h, d)]);
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
    static double brightness(const light_source& l) { return l.power.x + l.power.y + l.power.z; }

    /// Chooses the bins' size and divides every diffuse surface into bins.
    void cut(const scene& s, const geometry& shapes, const reference_settings& settings)
    {
        // Calls visit(shape, its number in `shapes`, its material).
        const auto each_shape = [&](auto visit) {
            std::uint32_t number = 0;
            for_each_shape(s, [&](const auto& list, auto) {
                for (const auto& x : list)
                    visit(x, number++, s.materials[x.material]);
            });
            number = shapes.first_triangle();
            for (const auto& l : s.mesh_lights)
                number += static_cast<std::uint32_t>(l.surface.surface->triangles.size());
            for (const auto& m : s.meshes)
                for (std::size_t t = 0; t < m.surface->triangles.size(); ++t) {
                    const auto c = corners_of(m, t);
                    visit(polygon{{c[0], c[1], c[2]}, m.material}, number++, s.materials[m.material]);
                }
        };
        double area = 0;
        bool shiny = false;
        each_shape([&](const auto& x, std::uint32_t, const material& m) {
            area += is_diffuse(s.materials, m) ? surface_area(x) : 0;
            for (const auto* part : parts_of(s.materials, m))
                shiny = shiny || !is_diffuse(*part) || is_coated(*part);
        });
        if (!shiny || !(area > 0))
            return;
        // Larger bins have less noise and more blur. The best edge is proportional to the number of paths to the power
        // -1/4.
        bin_ = settings.bin > 0 ? settings.bin
                                : std::sqrt(area) / (8 * std::pow(static_cast<double>(settings.paths), 0.25));
        each_shape([&](const auto& x, std::uint32_t number, const material& m) {
            surfaces_.resize(std::max<std::size_t>(surfaces_.size(), number + std::size_t{1}));
            if (!is_diffuse(s.materials, m) || !(surface_area(x) > 0))
                return;
            auto& surface = surfaces_[number];
            surface.bins.emplace(bins_of(x, bin_));
            surface.first = size_;
            size_ += 2 * std::visit([](const auto& b) { return b.size(); }, *surface.bins);
            require_few_bins(size_, bin_);
        });
    }

    /// The bin at `h` on the side that a ray of direction d hits.
    std::uint32_t bin_at(const hit& h, const dvec3& d) const
    {
        const auto& surface = surfaces_[h.shape];
        const std::uint32_t in_shape = std::visit([&](const auto& b) { return b.at(h.position); }, *surface.bins);
        return surface.first + 2 * in_shape + (glm::dot(h.normal, d) > 0 ? 1 : 0);
    }

    std::uint64_t trace_group(
        const scene& s, const geometry& shapes, const reference_settings& settings, std::uint32_t group, watch& w)
    {
        std::vector<dvec3> flux(size_, dvec3(0));
        random_stream random(settings.seed, 1, group);
        const surfaces met(s, shapes);
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
        out.assign(size_, glm::vec3(0));
        for (const auto& surface : surfaces_)
            if (surface.bins)
                std::visit(
                    [&](const auto& b) {
                        for (std::uint32_t i = 0; i < 2 * b.size(); ++i)
                            if (const double area = b.area(i / 2); area > 0)
                                out[surface.first + i] = glm::vec3(
                                    flux[surface.first + i] / (area * static_cast<double>(paths_per_group_)));
                    },
                    *surface.bins);
        return hits;
    }

    /// Traces one path up to its first diffuse surface, and on from there if a coat or another part of a mixture
    /// reflects it. Returns how often it added to a bin.
    std::uint64_t trace_path(const surfaces& all, const geometry& shapes, const reference_settings& settings,
        random_stream& random, std::vector<dvec3>& flux) const
    {
        const auto* light = &lights_.front();
        if (lights_.size() > 1) {
            double u = random();
            for (const auto& l : lights_) {
                light = &l;
                if ((u -= l.probability) < 0)
                    break;
            }
        }
        const auto emitted = shapes.emit(*light, random);
        dvec3 power = emitted.power / light->probability;
        ray r = emitted.from;
        std::uint64_t added = 0;
        bool from_light = true; // straight, or through clear surfaces
        for (std::uint32_t surface = 1; surface <= settings.photon_depth; ++surface) {
            const hit h = shapes.nearest(r);
            if (h.shape == nothing || h.light != nothing)
                return added;
            if (all.passes(h, random)) {
                r = {h.position, r.direction, h.shape};
                continue;
            }
            const auto met = all.met(h, random);
            const auto& m = met.of();
            const auto bounce = is_coated(m) ? off_coat(m, h, r.direction, random, true)
                : is_diffuse(m)              ? specular_bounce{.weight = 0}
                                             : specular_of_light(m, h, r.direction, random);
            if (const auto* base = from_light ? nullptr : all.base(h)) { // else direct light: see the path tracer
                const double passed = is_diffuse(m) ? 1 - bounce.weight : passes_coat(*base, h, r.direction, random);
                flux[bin_at(h, r.direction)] += power * passed * facing_normals(h, r.direction).received(r.direction);
                ++added;
            }
            from_light = false;
            if (bounce.adjoint == 0 || bounce.weight == 0)
                return added;
            power *= (is_coated(m) ? dvec3(1) : met.reflectance()) * (bounce.adjoint * bounce.weight);
            r = {h.position, bounce.direction, h.shape};
        }
        return added;
    }

    struct binned_surface {
        std::optional<surface_bins> bins; ///< of a diffuse shape
        std::uint32_t first = 0;          ///< of its bins; each has two, for the two sides
    };
    std::vector<light_source> lights_;
    std::vector<binned_surface> surfaces_; ///< by shape
    std::uint32_t size_ = 0;
    double bin_ = 0;
    std::uint64_t paths_per_group_ = 0;
    std::vector<std::vector<glm::vec3>> irradiance_; ///< by group and bin
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
