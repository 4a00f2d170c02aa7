// Render settings by stage: the paper's parameters and extensions. setting_table.hpp has the range of each setting, and
// its name in scene files and on the command line.
#pragma once

#include <photongrid/estimate/estimate_settings.hpp>
#include <photongrid/map/surplus_kind.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A number, or a length, that the renderer chooses for the scene (render/pilot.hpp).
inline constexpr std::uint32_t automatic_number = 0xFFFFFFFFu;
inline constexpr double automatic_length = -1;

/// How a photon map is built: sorted_map (2.2.1), routed_map (2.2.2), block_map, or whichever of a sorted map in a
/// fitted grid and a block map suits the photons (fitted_map).
enum class map_builder { sort, route, blocks, automatic };

/// How photons leave the lights: in proportion to power alone; or more often where pilot paths stored photons
/// (trace/emission_guide.hpp).
enum class photon_emission { power, guided };

/// Which part of the light a picture shows. Photons are divided by their paths: a caustic photon has hit mirrors and
/// glass only, an indirect photon a diffuse surface too. Lamps that are directly visible count as direct light.
enum class light_part { all, direct, caustic, indirect };

/// The photon map (2.1, 2.2).
struct map_settings {
    std::uint32_t photons = 65000; ///< photons stored
    /// Caustic photons stored in a map of their own; 0: they are in the map of all photons.
    std::uint32_t caustic_photons = 0;
    std::uint32_t photon_depth = 32;                    ///< the most surfaces that a photon path hits
    photon_emission emission = photon_emission::guided; ///< how photons leave the lights
    map_builder builder = map_builder::sort;            ///< how the map is built
    std::uint32_t slots = 4;                            ///< m: routed cells have m x m slots
    surplus_kind surplus = surplus_kind::photons;       ///< photons for which a routed cell has no slot
    /// Cells of a sorted or routed map over the scene; 0, 0, 0: fitted to the photons and k (fitting_grid.hpp).
    glm::uvec3 grid{25, 25, 50};

    /// Whether the map is in the grid that these settings give.
    bool has_given_grid() const
    {
        return grid != glm::uvec3(0) && (builder == map_builder::sort || builder == map_builder::route);
    }
    /// Sets the grid. An automatic map has a grid of its own, so one that is given makes it a sorted map.
    void use_grid(glm::uvec3 given)
    {
        grid = given;
        if (given != glm::uvec3(0) && builder == map_builder::automatic)
            builder = map_builder::sort;
    }
    /// The same settings, with defaults for those that this builder does not use.
    map_settings in_use() const
    {
        map_settings s = *this;
        if (builder != map_builder::route) {
            s.slots = map_settings{}.slots;
            s.surplus = map_settings{}.surplus;
        }
        if (!has_given_grid())
            s.grid = glm::uvec3(0);
        return s;
    }
    bool operator==(const map_settings&) const = default;
};

/// How indirect light that no mirror or glass focuses is computed where eye rays end: from the photons there; or by a
/// final gather, which looks at the photons of all other surfaces from there (final_gather.hpp); or by paths that go on
/// from there and look at caustic photons alone (gathered_paths.hpp).
enum class indirect_kind { map, gather, paths };

/// How the radii of estimates change from pass to pass: each pass finds its own by its search; or they shrink from
/// those that the search finds in a map of its own (shrinking_radii.hpp), if the picture has several passes.
enum class radius_kind { per_pass, shrinking };

/// Whether a picture reports the bias of its pixels (reports_bias).
enum class bias_report { automatic, no, yes };

/// The irradiance estimate (the paper's radiance estimate) of a picture (2.3).
struct estimate_settings {
    std::uint32_t k = 500;                               ///< photons sought per estimate
    std::uint32_t caustic_k = 100;                       ///< the same in a map of caustic photons of its own
    double max_radius = 0.1;                             ///< m
    search_kind search = search_kind::exact_k;           ///< which photons an estimate uses
    filter_kind filter = filter_kind::silverman;         ///< weight by distance
    bias_kind bias = bias_kind::unbiased;                ///< whether the photon that sets the radius counts
    leak_policy leaks{.side = true, .min_cosine = 0.5f}; ///< which photons are rejected
    edge_correction edges = edge_correction::probes;     ///< needs leak_policy::min_cosine above 0; probes: else none
    indirect_kind indirect = indirect_kind::map;         ///< how indirect light is computed
    std::uint32_t gather_rays = 16;                      ///< rays or paths of a final gather per eye ray
    radius_kind radii = radius_kind::shrinking;          ///< from pass to pass, if there are several
    /// Estimates are interpolated between those that are at most so many of their radii away (2.4, 4.5;
    /// interpolated_estimates.hpp), at most 0.5; 0: none are.
    double interpolation = 0.5;

    /// The photons sought in the map of caustic photons, or in the other.
    std::uint32_t sought(bool of_caustics) const { return of_caustics ? caustic_k : k; }
    std::uint32_t& sought(bool of_caustics) { return of_caustics ? caustic_k : k; }
    bool operator==(const estimate_settings&) const = default;
};

/// The weight of an eye ray in a pixel by the place that it goes through: even over the pixel; or falling linearly from
/// the pixel's middle to those of its neighbours (a tent).
enum class pixel_filter { box, tent };

/// The eye rays (2.4).
struct view_settings {
    std::uint32_t spp = 4;                   ///< eye rays per pixel and pass
    std::uint32_t light_samples = 8;         ///< shadow rays per light and eye ray; a point light needs one
    std::uint32_t depth = 64;                ///< the most reflections and refractions of an eye ray
    pixel_filter filter = pixel_filter::box; ///< of pixels with several eye rays

    bool operator==(const view_settings&) const = default;
};

/// The picture.
struct output_settings {
    std::uint32_t width = 512;  ///< pixels, 1 to 16384
    std::uint32_t height = 512; ///< pixels, 1 to 16384
    /// The picture is the mean of so many passes, each with its own photons, eye rays and shadow rays. With until_error
    /// or seconds it is the mean of at most so many, and 1 then means most_passes, as does automatic_number.
    std::uint32_t passes = 1;
    /// The picture ends once its error is at most this (picture_error.hpp): a share of the radiance; 0: off.
    double until_error = 0;
    double percentile = 0.95; ///< share of the pixels whose errors are to be at most until_error, 0 to 1
    /// The picture ends before a pass that would end later than after this time of drawing, s; 0: off. Not stored in
    /// scene files, because the picture depends on the machine.
    double seconds = 0;
    light_part only = light_part::all; ///< the part of the light to draw
    /// Whether the picture has the layer `bias`, and until_error counts it. Automatic: with until_error, of a picture
    /// whose radii shrink; others do not end by an error that their blur exceeds.
    bias_report report_bias = bias_report::automatic;
    /// EV for tone-mapped output: pixel values times 2^exposure; none: fitted to the picture.
    std::optional<double> exposure{};
    bool aov = false; ///< radius, count and relative standard error of the estimate per pixel
    /// Pixels per band of whole rows, of which a band has at least 8; bounds device memory. Changes results only by
    /// rounding, on cpu. Not stored in scene files.
    std::uint32_t band = 1u << 20;

    /// The most passes that a picture may have.
    static constexpr std::uint32_t most_passes = 65536;
    /// Whether something else than the number of passes may end the picture.
    bool has_stop_rule() const { return until_error > 0 || seconds > 0; }
    /// The number of passes after which the picture ends at the latest.
    std::uint32_t passes_at_most() const
    {
        return passes == automatic_number || (has_stop_rule() && passes == 1) ? most_passes : passes;
    }
    /// The same settings, with no rule that ends the picture before its passes.
    output_settings without_stop_rule() const
    {
        output_settings s = *this;
        s.passes = passes_at_most();
        s.until_error = s.seconds = 0;
        s.percentile = output_settings{}.percentile;
        return s;
    }
    bool operator==(const output_settings&) const = default;
};

/// The pass of a picture that settings are for (settings_of_pass). The eye rays of a pixel, their shadow rays and their
/// final gathers are stratified over all passes: each has its place in sequences that depend on the picture's seed.
struct pass_place {
    std::uint32_t number = 0;
    std::uint32_t seed_change = 0; ///< the pass's seed xor the picture's

    bool operator==(const pass_place&) const = default;
};

/// How to render.
struct render_settings {
    map_settings map{};
    estimate_settings estimate{};
    view_settings view{};
    output_settings output{};
    std::uint32_t seed = 1; ///< seed of all random numbers; the same seed gives the same picture
    pass_place pass{};      ///< not a setting of the user's

    bool operator==(const render_settings&) const = default;
};

namespace detail {
    /// The numbers of `s` that may be automatic.
    template <class Settings>
    auto numbers_of(Settings& s)
    {
        return std::array{&s.map.photons, &s.map.caustic_photons, &s.estimate.k, &s.estimate.caustic_k, &s.view.spp,
            &s.view.light_samples, &s.output.passes};
    }
} // namespace detail

/// Whether numbers have to be measured by a pilot.
inline bool needs_pilot(const render_settings& s)
{
    const auto numbers = detail::numbers_of(s);
    return std::any_of(numbers.begin(), numbers.end(), [](const auto* n) { return *n == automatic_number; });
}
/// Whether the renderer has to choose some of the settings.
inline bool is_automatic(const render_settings& s)
{
    return needs_pilot(s) || s.estimate.max_radius == automatic_length;
}
/// Settings that the renderer chooses, all that it can choose.
inline render_settings automatic_settings()
{
    render_settings s;
    for (auto* number : detail::numbers_of(s))
        *number = automatic_number;
    s.estimate.max_radius = automatic_length;
    s.map.grid = glm::uvec3(0);
    s.map.builder = map_builder::automatic;
    return s;
}
/// `s` with the numbers of `otherwise` in place of automatic ones.
inline render_settings with_numbers(render_settings s, const render_settings& otherwise)
{
    const auto numbers = detail::numbers_of(s);
    const auto others = detail::numbers_of(otherwise);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (*numbers[i] == automatic_number)
            *numbers[i] = *others[i];
    return s;
}

/// Whether a picture with settings `s` has light from a final gather.
inline bool gathers(const render_settings& s)
{
    return s.estimate.indirect == indirect_kind::gather
        && (s.output.only == light_part::all || s.output.only == light_part::indirect);
}
/// Whether it has light from paths that go on.
inline bool follows_paths(const render_settings& s)
{
    return s.estimate.indirect == indirect_kind::paths
        && (s.output.only == light_part::all || s.output.only == light_part::indirect);
}
/// Whether rays start where eye rays end, for indirect light.
inline bool has_gather_rays(const render_settings& s) { return gathers(s) || follows_paths(s); }
/// The rays that start at the end of each eye ray, for indirect light.
inline std::uint32_t rays_of_gather(const render_settings& s)
{
    return has_gather_rays(s) ? s.estimate.gather_rays : 0;
}
/// Whether the irradiance at photons is the same with settings `a` and `b` of the estimate, for a final gather.
inline bool same_irradiance(estimate_settings a, const estimate_settings& b)
{
    a.gather_rays = b.gather_rays;
    a.caustic_k = b.caustic_k;
    a.radii = b.radii;
    return a == b;
}
/// Whether it needs a map of caustic photons beside that of other photons.
inline bool has_caustic_map(const render_settings& s)
{
    return s.map.caustic_photons > 0
        && (s.output.only == light_part::all || s.output.only == light_part::caustic || has_gather_rays(s));
}
/// Whether the radii of its passes shrink. A picture of one pass would only lose by it.
inline bool has_shrinking_radii(const render_settings& s)
{
    return s.estimate.radii == radius_kind::shrinking && s.output.only != light_part::direct
        && s.output.passes_at_most() > 1;
}
/// Whether it reports the bias of its pixels.
inline bool reports_bias(const render_settings& s)
{
    return s.output.report_bias == bias_report::yes
        || (s.output.report_bias == bias_report::automatic && s.output.until_error > 0 && has_shrinking_radii(s));
}
/// Whether short rays find the edges of surfaces. Without a policy against adjoining surfaces the photons of these
/// would count, though their area does not.
inline bool probes_edges(const estimate_settings& s)
{
    return s.edges == edge_correction::probes && s.leaks.min_cosine > 0;
}
/// Whether photons keep the normals of their surfaces.
inline bool keeps_normals(const render_settings& s) { return s.estimate.leaks.needs_photon_normals() || gathers(s); }

/// The settings that reproduce the paper's method: its estimate (2.3: at least k, constant filter, no leak policy, no
/// edge correction, no interpolation, no final gather), one pass with one eye ray per pixel, which takes all shadow
/// rays of the pixel (light_samples times spp: by default 32, as in the paper's Cornell box); routed cells redistribute
/// power alone (2.2.2). Automatic numbers become the defaults. Other settings are unchanged.
/// \snippet snippets.cpp as_paper
inline render_settings as_paper(render_settings s)
{
    s = with_numbers(s, {});
    s.estimate.search = search_kind::at_least_k;
    s.estimate.filter = filter_kind::constant;
    s.estimate.bias = bias_kind::paper;
    s.estimate.leaks = {};
    s.estimate.edges = edge_correction::none;
    s.estimate.indirect = indirect_kind::map;
    s.estimate.radii = radius_kind::per_pass;
    s.estimate.interpolation = 0;
    s.map.surplus = surplus_kind::power;
    s.map.emission = photon_emission::power;
    s.map.caustic_photons = 0;
    s.output.passes = 1;
    s.output.until_error = s.output.seconds = 0;
    s.view.light_samples = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(std::uint64_t{s.view.light_samples} * std::max(s.view.spp, 1u), 65536));
    s.view.spp = 1;
    return s;
}

/// The settings of a consistent picture: its error goes to 0 as passes are added. Radii shrink, indirect light comes
/// from paths, and the picture has the most passes that it may have unless `s` has more than one or a stop rule. A
/// routed map becomes an automatic one, since it drops photons. First radii are of at most 50 photons. Automatic
/// numbers become some that suit most scenes: a pilot measures other pictures. Other settings are unchanged.
inline render_settings as_exact(render_settings s)
{
    render_settings usual;
    usual.map.photons = 200'000;
    usual.map.caustic_photons = 10'000;
    usual.view.spp = 1;
    s = with_numbers(s, usual);
    s.estimate.radii = radius_kind::shrinking;
    s.estimate.indirect = indirect_kind::paths;
    s.estimate.k = std::min(s.estimate.k, 50u);
    s.estimate.caustic_k = std::min(s.estimate.caustic_k, 50u);
    if (s.map.builder == map_builder::route)
        s.map.builder = map_builder::automatic;
    if (s.output.passes == 1 && !s.output.has_stop_rule())
        s.output.passes = output_settings::most_passes;
    return s;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
