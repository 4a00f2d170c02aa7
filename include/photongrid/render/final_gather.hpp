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
#include <photongrid/render/shrinking_radii.hpp>
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
    if (settings_.edges == edge_correction::polygons)
        correct_edges(device_, scene_, points_, photons_.normals, found, search_settings_.filter);
    if (probes_edges(settings_))
        correct_by_probes(device_, scene_, map_, search_settings_,
            detail::points_with_radii(device_, points_, found.irradiance, 1, detail::max_radius2(search_settings_)),
            photons_.normals, found);
    map_ = {};
    built_.irradiance = std::move(found.irradiance);
    points_ = {};
    photons_.directions = {};
    built_.nearest = fitted_map(device_, std::move(photons_), 1);
}

namespace detail {
    /// A ray that begins or continues the path of a gather ray.
    struct gather_ray {
        ray_of_pixels from; ///< the eye ray
        uint number;        ///< of the gather ray among those of the eye ray's end
        uint nth = 0;       ///< of the rays of its path
    };

    /// The settings by which that ray is traced.
    inline render_settings settings_of(const gather_ray& r, const scene_layout& layout)
    {
        // The first rays of a point are stratified together, and with those of the other passes. Later ones have random
        // numbers of their own.
        auto settings = r.from.settings;
        const uint eye_ray = r.from.ray;
        if (r.nth == 0) {
            const auto place = place_of(settings, eye_ray, splits_of(layout));
            settings.seed = place.seed ^ (place.branch + 1) * 0x85EBCA6Bu;
            settings.pass.seed_change = 0;
        } else {
            settings.seed
                ^= (eye_ray + 1) * 0x85EBCA6Bu ^ (r.nth * settings.estimate.gather_rays + r.number) * 0x9E3779B1u;
            settings.pass = {};
        }
        return settings;
    }

    /// Traces that ray from `starts`, from element `first` on, to its ends. `settings`: settings_of(r).
    template <backend B>
    eye_hits<B> gather_hits(B& device, const device_scene<B>& s, const eye_hits<B>& starts, uint first,
        const gather_ray& r, const render_settings& settings)
    {
        const launch pixels(r.from.pixels.elements, 0);
        const uint rays = settings.estimate.gather_rays;
        const auto place = place_of(settings, r.from.ray, splits_of(s.layout));
        eye_hits<B> hits(device, pixels.elements, starts.first_pixel + first);
        auto branches = device.template make<uint>(pixels.elements);
        device.template run<kernels::final_gather_ray>({pixels.elements, 0u, s.layout.features},
            {.strata = r.nth == 0 ? strata_of(rays) : glm::uvec2(1),
                .number = r.nth == 0 ? r.number : 0,
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
                .nth = place.nth * rays + r.number,
                .seed = settings.seed},
            hits, branches);
        return hits;
    }
} // namespace detail

/// What is looked up at ends of gather rays that are gathered from in their turn.
template <backend B>
struct near_light {
    const map_buffers<B>& caustics;                     ///< caustic photons ...
    pass_radii<B> radii{};                              ///< ... and the radii of estimates among them
    const buffer_of<B, glm::vec4>* sky_guide = nullptr; ///< sky_guide.hpp; null: there is none
};

/// What gather rays bring to the points where eye rays ended, of the pixels of one launch.
template <backend B>
struct gathering {
    buffer_of<B, glm::vec4> weights;  ///< rgb: of what comes by the path
    buffer_of<B, glm::vec4> gathered; ///< rgb: irradiance, W/m^2

    gathering(B& device, std::size_t n)
        : weights(device.template make<glm::vec4>(n)), gathered(device.template make<glm::vec4>(n))
    {
        device.template run<kernels::weight_one>(n, {}, reads(), writes(weights));
        device.template run<kernels::zero_vectors>(n, {}, reads(), writes(gathered));
    }
};

namespace detail {
    /// The correction of edges in what gather rays see: from afar that of probes is not worth its time.
    inline edge_correction edges_of_gather(const estimate_settings& s)
    {
        return s.edges == edge_correction::probes ? edge_correction::none : s.edges;
    }

    /// The irradiance of caustics at ends of gather rays.
    template <backend B>
    knn_estimates<B> caustics_at(B& device, const device_scene<B>& s, const near_light<B>& light,
        const eye_hits<B>& ends, const render_settings& settings)
    {
        estimate_sources<B> from{.scene = &s,
            .map = &light.caustics,
            .radii = light.radii.of_caustics(),
            .share2 = light.radii.share2,
            .search = search_for_caustics(settings),
            .edges = edges_of_gather(settings.estimate)};
        from.search.errors = from.search.biases = false;
        point_estimates<B> search(
            device, from, ends.points, ends.directions, running_estimate_kind::none, step_size::largest);
        while (!search.advance()) {}
        return search.take();
    }

    /// Adds direct light and caustics at the ends of gather rays that are gathered from in their turn. `of`: those
    /// rays, with settings_of them.
    template <backend B>
    void light_gather_ends(B& device, const device_scene<B>& s, const near_light<B>& light, const eye_hits<B>& ends,
        const gather_ray& of, gathering<B>& sum)
    {
        const std::size_t n = ends.points.size();
        auto direct = device.template make<glm::vec4>(n);
        const auto& settings = of.from.settings;
        auto one_sample = settings;
        one_sample.view.light_samples = 1;
        one_sample.seed ^= (of.number + 1) * 0xC2B2AE35u; // else rays of one point would see the same point of a lamp
        direct_light(device, s, {one_sample, of.from.ray, launch(n, 0)}, ends, direct, light.sky_guide);
        const auto found = caustics_at(device, s, light, ends, settings);
        device.template run<kernels::add_near_light>(n,
            {.share = 1.0f / static_cast<float>(settings.estimate.gather_rays)},
            reads(ends.points, sum.weights, direct, found.irradiance), writes(sum.gathered));
    }
} // namespace detail

/// What a final gather finds light in.
template <backend B>
struct gather_sources {
    const device_scene<B>& scene;
    const gather_map<B>& map;
    near_light<B> near;
};

/// Adds the irradiance that one of settings.estimate.gather_rays, `ray`, brings to the points where eye rays ended, to
/// `light`.
///
/// A ray that ends nearer than the radius of the estimates there goes on, up to three times, as a path does.
template <backend B>
void add_gather_rays(B& device, const gather_sources<B>& from, const detail::eye_hits<B>& eye_ends,
    detail::gather_ray ray, buffer_of<B, glm::vec4>& light)
{
    constexpr uint most_rays = 4; // one after the other
    const launch pixels = ray.from.pixels;
    const std::size_t n = pixels.elements;
    const float share = 1.0f / static_cast<float>(ray.from.settings.estimate.gather_rays);
    gathering<B> sum(device, n);
    knn_settings nearest;
    nearest.k = 1;
    nearest.leaks.min_cosine = detail::same_surface_cosine;
    std::optional<detail::eye_hits<B>> ends; // of the rays before
    for (ray.nth = 0; ray.nth < most_rays; ++ray.nth) {
        const auto& starts = ends ? *ends : eye_ends;
        const uint first = ends ? 0 : pixels.first;
        const bool is_last = ray.nth + 1 == most_rays;
        const auto settings = detail::settings_of(ray, from.scene.layout);
        auto hits = detail::gather_hits(device, from.scene, starts, first, ray, settings);
        const auto found = knn_neighbours(device, from.map.nearest, hits.points, hits.directions, nearest);
        device.template run<kernels::add_gathered>(n,
            {.share = share, .first = first, .leaves_near = is_last ? 0u : 1u},
            reads(starts.points, hits.directions, hits.throughputs, found.ids, found.distances2, from.map.irradiance),
            writes(hits.points, sum.weights, sum.gathered));
        if (is_last || detail::checked_count<kernels::is_near_end>(device, n, {}, reads(hits.points)) == 0)
            break;
        detail::light_gather_ends(
            device, from.scene, from.near, hits, {{settings, ray.from.ray, pixels}, ray.number, ray.nth}, sum);
        ends.emplace(std::move(hits));
    }
    device.template run<kernels::add_light>(pixels, {.first = pixels.first}, reads(sum.gathered), writes(light));
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
