// The final gather (Reichert 1992; Jensen 1996): indirect light from rays over the hemisphere of a point, each of which
// looks up the light at the surface that it meets. What is uneven in the estimates of a photon map is then seen from a
// distance, where it averages out. The irradiance at photons is computed beforehand, so that a look-up is a search for
// one photon (Christensen, Faster Photon Map Global Illumination, Journal of Graphics Tools 4(3), 1999).
//
//     once per map:  photons -> irradiance at photons -> gather_map
//     per eye ray:   final_gather_ray -> eye_bounce ... -> nearest photon -> add_gathered
//                        ^---------- direct light, caustics <-- near ends <------|
#pragma once

#include <photongrid/core/copy_vectors.kernel.hpp>
#include <photongrid/core/zero_vectors.kernel.hpp>
#include <photongrid/estimate/knn_neighbours.hpp>
#include <photongrid/map/fitted_map.hpp>
#include <photongrid/render/add_gathered.kernel.hpp>
#include <photongrid/render/add_light.kernel.hpp>
#include <photongrid/render/add_near_light.kernel.hpp>
#include <photongrid/render/is_near_end.kernel.hpp>
#include <photongrid/render/photon_point.kernel.hpp>
#include <photongrid/render/picture_search.hpp>
#include <photongrid/render/point_estimates.hpp>
#include <photongrid/render/weight_one.kernel.hpp>
#include <photongrid/trace/eye_rays.hpp>
#include <photongrid/trace/final_gather_ray.kernel.hpp>

#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace detail {
    /// The least cosine of the angle between the normals of a point and of the photon nearest to it, whose irradiance
    /// stands for the point's.
    inline constexpr float same_surface_cosine = 0.7f;

    template <backend B>
    photons<B> copy(B& device, const photons<B>& p)
    {
        const auto same = [&](const buffer_of<B, glm::vec4>& attribute) {
            auto copied = device.template make<glm::vec4>(attribute.size());
            device.template run<kernels::copy_vectors>(attribute.size(), {}, reads(attribute), writes(copied));
            return copied;
        };
        return {same(p.positions), same(p.powers), same(p.directions), same(p.normals)};
    }
} // namespace detail

/// A photon map as a final gather looks it up.
template <backend B>
struct gather_map {
    map_buffers<B> nearest; ///< photons with normals, for searches for one photon
    /// The irradiance at each photon, by id: rgb, W/m^2, of all light there, direct light too; w: squared radius of
    /// the estimate, m^2.
    buffer_of<B, glm::vec4> irradiance;
};

/// Computes the irradiance at photons, in steps: estimates with the settings of the picture's, but by the constant
/// filter. The photon itself counts. At its own place that makes the estimate too high, but at a point to which it is
/// the nearest photon, right: a disc around that point holds no photon, and the photon in question makes up for it
/// (docs/design/decisions.md, "The irradiance at photons").
template <backend B>
class gather_map_building {
public:
    /// Takes photons with directions and normals of all diffuse hits, first ones too. `device` and `s` must outlive it.
    /// \throws std::invalid_argument as knn_search and correct_edges do, backend_error.
    gather_map_building(B& device, const device_scene<B>& s, photons<B> p, const render_settings& settings);
    gather_map_building(const gather_map_building&) = delete;
    gather_map_building& operator=(const gather_map_building&) = delete;

    /// Runs a step. Returns whether the map is finished.
    /// \throws backend_error.
    bool advance();

    /// The map, when it is finished.
    gather_map<B> take() { return std::move(built_); }

private:
    void finish(knn_estimates<B> found);

    B& device_;
    const device_scene<B>& scene_;
    estimate_settings settings_;
    knn_settings search_settings_;
    photons<B> photons_;             // in the order of their ids
    buffer_of<B, glm::vec4> points_; // at the photons
    map_buffers<B> map_;             // for the estimates
    std::optional<knn_search<B>> search_;
    gather_map<B> built_;
};

// Defined outside the class: functions defined inside are implicitly inline, and `extern template` does not suppress
// them.

template <backend B>
gather_map_building<B>::gather_map_building(
    B& device, const device_scene<B>& s, photons<B> p, const render_settings& settings)
    : device_(device), scene_(s), settings_(settings.estimate), search_settings_(detail::search_for(settings.estimate)),
      photons_(std::move(p)), points_(device.template make<glm::vec4>(photons_.size()))
{
    search_settings_.filter = filter_kind::constant;
    device_.template run<kernels::photon_point>(points_.size(), {}, reads(photons_.positions), writes(points_));
    map_ = fitted_map(device_, detail::copy(device_, photons_), search_settings_.k);
    search_.emplace(device_, map_, points_, photons_.normals, search_settings_);
}

template <backend B>
bool gather_map_building<B>::advance()
{
    if (search_ && search_->advance(8).finished)
        finish(std::move(*search_).estimates());
    return !search_;
}

template <backend B>
void gather_map_building<B>::finish(knn_estimates<B> found)
{
    search_.reset();
    map_ = {};
    if (settings_.edges != edge_correction::none)
        correct_edges(device_, scene_, points_, photons_.normals, found, search_settings_.filter);
    built_.irradiance = std::move(found.irradiance);
    points_ = {};
    photons_.directions = {};
    built_.nearest = fitted_map(device_, std::move(photons_), 1);
}

namespace detail {
    /// The settings by which ray `nth` of the path that gather ray `number` begins is traced.
    inline render_settings settings_of_gather_ray(
        render_settings settings, const scene_layout& layout, uint eye_ray, uint number, uint nth)
    {
        // The first rays of a point are stratified together, and with those of the other passes. Later ones have random
        // numbers of their own.
        if (nth == 0) {
            const auto place = place_of(settings, eye_ray, splits_of(layout));
            settings.seed = place.seed ^ (place.branch + 1) * 0x85EBCA6Bu;
            settings.pass.seed_change = 0;
        } else {
            settings.seed ^= (eye_ray + 1) * 0x85EBCA6Bu ^ (nth * settings.estimate.gather_rays + number) * 0x9E3779B1u;
            settings.pass = {};
        }
        return settings;
    }

    /// Traces that ray from `starts`, from element `first` on, to its ends. `settings`: settings_of_gather_ray.
    template <backend B>
    eye_hits<B> gather_hits(B& device, const device_scene<B>& s, const eye_hits<B>& starts, uint first,
        const render_settings& settings, uint eye_ray, uint number, uint nth, launch pixels)
    {
        const uint rays = settings.estimate.gather_rays;
        const auto place = place_of(settings, eye_ray, splits_of(s.layout));
        eye_hits<B> hits(device, pixels.elements, starts.first_pixel + first);
        auto branches = device.template make<uint>(pixels.elements);
        device.template run<kernels::final_gather_ray>({pixels.elements, 0u, s.layout.features},
            {.strata = nth == 0 ? strata_of(rays) : glm::uvec2(1),
                .number = nth == 0 ? number : 0,
                .first = first,
                .first_pixel = starts.first_pixel,
                .nth = place.nth,
                .seed = settings.seed},
            reads(s.records, starts.points, starts.surfaces),
            writes(hits.points, hits.directions, hits.throughputs, hits.surfaces, hits.emissions, branches));
        trace_to_ends(device, s, pixels,
            {.branch = 0,
                .splits = 0,
                .depth = settings.view.depth,
                .light_samples = 0.0f,
                .nth = place.nth * rays + number,
                .seed = settings.seed},
            hits, branches);
        return hits;
    }

    /// The irradiance of caustics at ends of gather rays.
    template <backend B>
    knn_estimates<B> caustics_at(B& device, const device_scene<B>& s, const map_buffers<B>& caustics,
        const pass_radii<B>& radii, const eye_hits<B>& ends, const render_settings& settings)
    {
        estimate_sources<B> from{.scene = &s,
            .map = &caustics,
            .radii = radii.of_caustics(),
            .share2 = radii.share2,
            .search = search_for_caustics(settings),
            .edges = settings.estimate.edges};
        from.search.errors = from.search.biases = false;
        point_estimates<B> search(
            device, from, ends.points, ends.surfaces, running_estimate_kind::none, step_size::largest);
        while (!search.advance()) {}
        return search.take();
    }

    /// Adds direct light and caustics at the ends of gather rays that are gathered from in their turn.
    template <backend B>
    void light_gather_ends(B& device, const device_scene<B>& s, const map_buffers<B>& caustics,
        const pass_radii<B>& radii, const eye_hits<B>& ends, const buffer_of<B, glm::vec4>& weights,
        const render_settings& settings, uint eye_ray, uint number, buffer_of<B, glm::vec4>& gathered)
    {
        const std::size_t n = ends.points.size();
        auto direct = device.template make<glm::vec4>(n);
        auto one_sample = settings;
        one_sample.view.light_samples = 1;
        one_sample.seed ^= (number + 1) * 0xC2B2AE35u; // else rays of one point would see the same point of a lamp
        direct_light(device, s, ends, one_sample, eye_ray, launch(n, 0), direct);
        const auto found = caustics_at(device, s, caustics, radii, ends, settings);
        device.template run<kernels::add_near_light>(n,
            {.share = 1.0f / static_cast<float>(settings.estimate.gather_rays)},
            reads(ends.points, weights, direct, found.irradiance), writes(gathered));
    }
} // namespace detail

/// Adds the irradiance that ray number `number` of settings.estimate.gather_rays brings to the points where eye rays
/// ended, for the pixels of `pixels`, to `light`. `eye_ray`: number of the eye ray; `caustics`: map of caustic photons.
///
/// A ray that ends nearer than the radius of the estimates there goes on, up to three times, as a path does.
template <backend B>
void add_gather_rays(B& device, const device_scene<B>& s, const gather_map<B>& map, const map_buffers<B>& caustics,
    const detail::eye_hits<B>& eye_ends, const render_settings& settings, uint eye_ray, uint number, launch pixels,
    buffer_of<B, glm::vec4>& light)
{
    constexpr uint most_rays = 4; // one after the other
    const std::size_t n = pixels.elements;
    const uint rays = settings.estimate.gather_rays;
    const auto make = [&] { return device.template make<glm::vec4>(n); };
    auto weights = make(), gathered = make();
    device.template run<kernels::weight_one>(n, {}, reads(), writes(weights));
    device.template run<kernels::zero_vectors>(n, {}, reads(), writes(gathered));
    knn_settings nearest;
    nearest.k = 1;
    nearest.leaks.min_cosine = detail::same_surface_cosine;
    std::optional<detail::eye_hits<B>> ends; // of the rays before
    for (uint nth = 0; nth < most_rays; ++nth) {
        const auto& starts = ends ? *ends : eye_ends;
        const uint first = ends ? 0 : pixels.first;
        const auto of_ray = detail::settings_of_gather_ray(settings, s.layout, eye_ray, number, nth);
        auto hits = detail::gather_hits(device, s, starts, first, of_ray, eye_ray, number, nth, launch(n, 0));
        const auto found = knn_neighbours(device, map.nearest, hits.points, hits.surfaces, nearest);
        device.template run<kernels::add_gathered>(n,
            {.share = 1.0f / static_cast<float>(rays), .first = first, .leaves_near = nth + 1 < most_rays ? 1u : 0u},
            reads(starts.points, hits.directions, hits.throughputs, found.ids, found.distances2, map.irradiance),
            writes(hits.points, weights, gathered));
        if (nth + 1 == most_rays || detail::checked_count<kernels::is_near_end>(device, n, {}, reads(hits.points)) == 0)
            break;
        detail::light_gather_ends(device, s, caustics, {}, hits, weights, of_ray, eye_ray, number, gathered);
        ends.emplace(std::move(hits));
    }
    device.template run<kernels::add_light>(pixels, {.first = pixels.first}, reads(gathered), writes(light));
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
