// Builds a photon map of a world (figure 1, left): traces photons and puts them into a map. It runs again only for
// another world, another pass, or if a setting that same_map() compares changes.
#pragma once

#include <photongrid/map/map_builders.hpp>
#include <photongrid/render/final_gather.hpp>
#include <photongrid/render/rough_photons.hpp>
#include <photongrid/render/shrinking_radii.hpp>
#include <photongrid/render/stage_clock.hpp>
#include <photongrid/render/world.hpp>
#include <photongrid/trace/pilot_tracing.hpp>
#include <photongrid/trace/trace_photons.hpp>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A part of the light in a photon map of its own.
template <backend B>
struct light_map {
    photon_request request;
    map_buffers<B> map;      ///< in the coordinates of the world's scene
    traced_photons<B> trace; ///< without the photons, which are in `map`
};

/// The result of build_map and the input of draw: the light of a world as photons.
template <backend B>
struct built_map {
    std::shared_ptr<photongrid::world<B>> world;
    /// What is searched where rays end, as requests_of() lists it. The first has all photons, or those that the others
    /// leave to it; only caustic ones if rays of a final gather start there, none with both.
    std::vector<light_map<B>> lights;
    render_stats stats;                       ///< trace_photons, build_map and map
    std::optional<gather_map<B>> gather;      ///< of all photons, for a final gather
    bool splits_caustics = false;             ///< the first map has no caustic photons
    std::optional<rough_photons<B>> on_rough; ///< if the scene needs them

    const device_scene<B>& scene() const { return world->scene; }
    const map_buffers<B>& map() const { return lights.front().map; }
    /// The map with the caustic photons.
    const map_buffers<B>& caustics() const { return lights.back().map; }
};

/// The parts of the light (map_buffers.hpp) that a picture of `only` needs in its map.
constexpr uint parts_of(light_part only)
{
    return only == light_part::caustic ? caustic_part : only == light_part::indirect ? other_part : every_part;
}
/// The parts of the light in the map that is searched where rays end, for a picture with settings `s`.
inline uint parts_at_ends(const render_settings& s)
{
    return has_gather_rays(s) ? caustic_part : parts_of(s.output.only);
}

/// Whether the photon map of a world with settings `as` is that with `bs`: the same photons in the same map. The
/// settings of other stages do not matter.
inline bool same_map(const render_settings& as, const render_settings& bs)
{
    const bool fitted = !as.map.has_given_grid() && as.map.builder != map_builder::blocks;
    return as.seed == bs.seed && as.map.in_use() == bs.map.in_use()
        && (!fitted || as.estimate.k == bs.estimate.k) // a fitted map depends on k
        && (!fitted || as.map.caustic_photons == 0 || as.estimate.sought(true) == bs.estimate.sought(true))
        && (as.estimate.leaks.needs_photon_normals() || !bs.estimate.leaks.needs_photon_normals())
        && parts_of(as.output.only) == parts_of(bs.output.only) && parts_at_ends(as) == parts_at_ends(bs)
        && gathers(as) == gathers(bs) && (!gathers(as) || same_irradiance(as.estimate, bs.estimate))
        && (as.output.only != light_part::direct || bs.output.only == light_part::direct); // it has no photons
}

/// What a map is for: all light, or only the first radii of estimates (shrinking_radii.hpp).
enum class map_use { light, first_radii };

/// Builds a photon map batch by batch, so that it can be interrupted.
template <backend B>
class map_building {
public:
    /// It traces nothing yet. In a scene that has no indirect light the map has no photons. It adds emission guides to
    /// the world.
    /// \throws std::invalid_argument for settings that check() rejects, backend_error.
    map_building(B& device, std::shared_ptr<world<B>> of, const render_settings& settings, map_use use = map_use::light)
        : device_(device), settings_(settings), use_(use)
    {
        check_numbers(settings);
        built_.world = std::move(of);
        built_.splits_caustics = settings_.map.caustic_photons > 0;
        for (const auto& request : requests_of(settings_, layout()))
            if (use_ == map_use::light || !request.on_rough())
                built_.lights.push_back({request, {}, {}});
        detail::time_stage(device, built_.stats.trace_photons, [&] { begin_tracing(); });
    }
    map_building(const map_building&) = delete;
    map_building& operator=(const map_building&) = delete;

    /// A step: the left side of figure 1, which runs again only if geometry, materials or lights change.
    /// \throws backend_error.
    void advance()
    {
        if (stage() == "trace_photons")
            trace_photons(); // 2.1
        else if (!is_built_)
            build_map(); // 2.2
        else
            estimate_at_photons();
    }
    /// The stage of the next step.
    std::string_view stage() const { return pilot_ || tracing_ ? "trace_photons" : "build_map"; }
    /// Whether take() may be called.
    bool finished() const { return is_built_ && (!gather_ || use_ == map_use::first_radii); }
    /// The fraction of the photons that have been traced.
    double fraction() const
    {
        if (!pilot_ && !tracing_)
            return 1.0;
        double done = 0, all = 0;
        for (std::size_t i = 0; i < built_.lights.size(); ++i) {
            const double photons = built_.lights[i].request.photons;
            done += photons * (i < at_ ? 1.0 : i == at_ && tracing_ ? tracing_->fraction() : 0.0);
            all += photons;
        }
        return all > 0 ? done / all : 0.0;
    }

    /// The finished map.
    built_map<B> take() { return std::move(built_); }

private:
    /// Traces one more batch of photon paths.
    void trace_photons()
    {
        detail::time_stage(device_, built_.stats.trace_photons, [&] {
            if (tracing_) {
                tracing_->advance();
            } else if (pilot_ && pilot_->advance()) {
                built_.world->add_guide(settings_, traced().request, pilot_->guide());
                pilot_.reset();
                begin_tracing();
            }
            if (tracing_ && tracing_->finished())
                end_tracing();
        });
    }
    /// Builds the map of the photons in one step.
    void build_map()
    {
        detail::time_stage(device_, built_.stats.build_map, [&] { build(); });
        is_built_ = true;
    }
    /// Computes the irradiance at photons for a final gather.
    void estimate_at_photons()
    {
        detail::time_stage(device_, built_.stats.build_map, [&] {
            if (gather_->advance()) {
                built_.gather = gather_->take();
                gather_.reset();
            }
        });
    }
    const scene_layout& layout() const { return built_.scene().layout; }
    /// The light map whose photons are traced.
    light_map<B>& traced() { return built_.lights[at_]; }
    /// Begins to trace its photons, or pilot paths if a guide is wanted that there is not yet.
    void begin_tracing()
    {
        auto& request = traced().request;
        const bool guided = is_guided(settings_, request);
        const auto* guide = guided ? built_.world->guide(settings_, request) : nullptr;
        if (guided && guide == nullptr) {
            pilot_.emplace(device_, built_.scene(), settings_, request);
            return;
        }
        if (guide != nullptr && guide->has_none_useful)
            request.most_paths = request.photons; // what there is may be rare, but is dim
        auto with = settings_;
        if (request.are_caustics_of_others)
            with.seed ^= 0xB5297A4Du; // else they would be on the paths of the other photons
        if (request.on_rough())
            with.seed ^= 0x68E31DA4u;
        tracing_.emplace(device_, built_.scene(), with, request, guide != nullptr ? *guide : emission_guide{});
    }
    /// Ends tracing for a light map, and begins with the next.
    void end_tracing()
    {
        traced().trace = tracing_->take();
        tracing_.reset();
        if (++at_ < built_.lights.size())
            begin_tracing();
    }
    void build()
    {
        if (built_.lights.back().request.on_rough())
            build_on_rough();
        auto& first = built_.lights.front().trace.photons;
        if (gathers(settings_) && built_.splits_caustics) // all photons are the gather's alone
            gather_.emplace(device_, built_.scene(), std::exchange(first, no_photons()), settings_);
        else if (gathers(settings_))
            gather_.emplace(device_, built_.scene(), detail::copy(device_, first), settings_);
        const uint parts = built_.splits_caustics ? every_part : parts_at_ends(settings_);
        const auto builder = settings_.map.builder;
        for (auto& light : built_.lights) {
            const bool own = light.request.are_caustics_of_others;
            // Caustics crowd in few cells, where a photon that has a slot would stand for more than an estimate seeks.
            light.map = map_of(std::move(light.trace.photons), own ? every_part : parts, settings_.estimate.sought(own),
                own && builder == map_builder::route ? map_builder::sort : builder);
        }
        const auto& map = built_.map();
        auto& made = built_.stats.map;
        made.builder = settings_.map.builder;
        if (made.builder == map_builder::automatic)
            made.builder = map.has_blocks() ? map_builder::blocks : map_builder::sort;
        made.blocks = detail::block_count(map.in_blocks);
        made.cells = cell_count(map.cells_of);
        made.resolution = glm::uvec3(map.cells_of.resolution);
        made.overflowing_cells = map.overflowing_cells;
        made.left_out = map.left_out;
    }

    /// They are no irradiance, so they are none of the light maps.
    void build_on_rough()
    {
        auto of = std::move(built_.lights.back().trace.photons);
        built_.lights.pop_back();
        auto p = detail::copy(device_, of);
        const auto k = settings_.estimate.sought(has_caustic_map(settings_));
        built_.on_rough.emplace(
            rough_photons<B>{fitted_map(device_, std::move(p), k), std::move(of.powers), std::move(of.directions)});
    }

    photons<B> no_photons()
    {
        const auto make = [&] { return device_.template make<glm::vec4>(0); };
        return {make(), make(), make(), make()};
    }
    map_buffers<B> map_of(photons<B> p, uint parts, uint k, map_builder builder)
    {
        const auto& m = settings_.map;
        switch (builder) {
        case map_builder::blocks: return block_map(device_, std::move(p), parts);
        case map_builder::automatic: return fitted_map(device_, std::move(p), k, parts);
        case map_builder::sort:
        case map_builder::route: break;
        }
        const grid g = m.has_given_grid() ? make_grid(layout().low, layout().high, m.grid)
                                          : fitting_grid(device_, p, k, device_.caps().cells_per_radius);
        return builder == map_builder::sort
            ? sorted_map(device_, std::move(p), g, parts)
            : routed_map(device_, std::move(p), g, {m.slots, settings_.seed, parts, m.surplus});
    }

    B& device_;
    render_settings settings_;
    map_use use_;
    std::size_t at_ = 0; // number of the light map whose photons are traced
    bool is_built_ = false;
    built_map<B> built_;
    std::optional<pilot_tracing<B>> pilot_;        // of built_.scene()
    std::optional<photon_tracing<B>> tracing_;     // of built_.scene()
    std::optional<gather_map_building<B>> gather_; // of built_.scene()
};

/// The radii of pass number `pass`, with `first` the map built by `settings` of pass number radius_pass, which must
/// outlive them.
template <backend B>
pass_radii<B> radii_of_pass(const built_map<B>& first, const render_settings& settings, uint pass)
{
    pass_radii<B> radii{.share2 = shrunk_share2(pass)};
    for (const auto& light : first.lights)
        radii.firsts.push_back({&light.map, settings.estimate.sought(light.request.are_caustics_of_others)});
    return radii;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
