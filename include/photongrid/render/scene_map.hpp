// Builds a photon map of a world (figure 1, left): traces photons and puts them into a map. It runs again only for
// another world, another pass, or if a setting that same_map() compares changes.
#pragma once

#include <photongrid/map/map_builders.hpp>
#include <photongrid/render/final_gather.hpp>
#include <photongrid/render/shrinking_radii.hpp>
#include <photongrid/render/stage_clock.hpp>
#include <photongrid/render/world.hpp>
#include <photongrid/trace/pilot_tracing.hpp>
#include <photongrid/trace/trace_photons.hpp>

#include <memory>
#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A map of caustic photons alone.
template <backend B>
struct caustic_map {
    map_buffers<B> map;
    traced_photons<B> trace; ///< without the photons, which are in `map`
};

/// The result of build_map and the input of draw: a photon map of a world.
template <backend B>
struct built_map {
    std::shared_ptr<photongrid::world<B>> world;
    /// In the coordinates of the world's scene: all photons; without caustic ones if there is `caustics`; only those if
    /// rays of a final gather start where eye rays end; none with both.
    map_buffers<B> map;
    traced_photons<B> trace;                ///< without the photons, which are in the maps
    render_stats stats;                     ///< trace_photons, build_map and map
    std::optional<gather_map<B>> gather;    ///< of all photons, for a final gather
    std::optional<caustic_map<B>> caustics; ///< if the settings ask for it and the scene has mirrors or glass
    bool has_caustics_apart = false;        ///< `map` has no caustic photons; they are in `caustics`, if there are any

    const device_scene<B>& scene() const { return world->scene; }
    /// The map with the caustic photons.
    const map_buffers<B>& map_of_caustics() const { return caustics ? caustics->map : map; }
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

/// Builds a photon map batch by batch, so that it can be interrupted.
template <backend B>
class map_building {
public:
    /// It traces nothing yet. In a scene that has no indirect light the map has no photons. It adds emission guides to
    /// the world.
    /// \throws std::invalid_argument for settings that check() rejects, backend_error.
    map_building(B& device, std::shared_ptr<world<B>> of, const render_settings& settings)
        : device_(device), settings_(settings)
    {
        check(settings);
        built_.world = std::move(of);
        built_.has_caustics_apart = settings_.map.caustic_photons > 0;
        request_ = request_of(settings_, layout());
        detail::time_stage(device, built_.stats.trace_photons, [&] { begin_tracing(); });
    }
    map_building(const map_building&) = delete;
    map_building& operator=(const map_building&) = delete;

    /// Traces one more batch of photon paths; returns whether all photons are stored (2.1).
    /// \throws backend_error.
    bool trace_photons()
    {
        detail::time_stage(device_, built_.stats.trace_photons, [&] {
            if (tracing_) {
                tracing_->advance();
            } else if (pilot_ && pilot_->advance()) {
                built_.world->add_guide(settings_, request_, pilot_->guide());
                pilot_.reset();
                begin_tracing();
            }
            if (tracing_ && tracing_->finished())
                end_tracing();
        });
        return !pilot_ && !tracing_;
    }
    /// Builds the map of the photons (2.2) in one step. Returns true.
    /// \throws backend_error.
    bool build_map()
    {
        if (!is_built_)
            detail::time_stage(device_, built_.stats.build_map, [&] { build(); });
        is_built_ = true;
        return true;
    }
    /// Computes the irradiance at photons for a final gather, if there is one; returns whether it is done.
    /// \throws backend_error.
    bool estimate_at_photons()
    {
        if (!gather_)
            return true;
        detail::time_stage(device_, built_.stats.build_map, [&] {
            if (gather_->advance()) {
                built_.gather = gather_->take();
                gather_.reset();
            }
        });
        return !gather_;
    }

    /// Whether take() may be called.
    bool finished() const { return is_built_ && !gather_; }
    /// The fraction of the photons that have been traced.
    double fraction() const
    {
        if (!pilot_ && !tracing_)
            return 1.0;
        const double caustics = caustic_request_of(settings_, layout()).photons;
        const double all = request_of(settings_, layout()).photons + caustics, now = request_.photons;
        const double before = is_of_caustics_ ? all - caustics : 0;
        return all > 0 ? (before + (tracing_ ? tracing_->fraction() : 0.0) * now) / all : 0.0;
    }

    /// The finished map.
    built_map<B> take() { return std::move(built_); }

private:
    const scene_layout& layout() const { return built_.scene().layout; }
    /// Begins to trace the photons of request_, or pilot paths if a guide is wanted that there is not yet.
    void begin_tracing()
    {
        const bool guided = is_guided(settings_, request_);
        const auto* guide = guided ? built_.world->guide(settings_, request_) : nullptr;
        if (guided && guide == nullptr) {
            pilot_.emplace(device_, built_.scene(), settings_, request_);
            return;
        }
        if (guide != nullptr && guide->has_none_useful)
            request_.most_paths = request_.photons; // what there is may be rare, but is dim
        auto with = settings_;
        if (is_of_caustics_)
            with.seed ^= 0xB5297A4Du; // else they would be on the paths of the other photons
        tracing_.emplace(device_, built_.scene(), with, request_, guide != nullptr ? *guide : emission_guide{});
    }
    /// Ends tracing for a request, and begins with the caustic photons if they come next.
    void end_tracing()
    {
        auto traced = tracing_->take();
        tracing_.reset();
        if (is_of_caustics_) {
            built_.caustics->trace = std::move(traced);
            return;
        }
        built_.trace = std::move(traced);
        const auto caustics = caustic_request_of(settings_, layout());
        if (caustics.photons == 0)
            return;
        built_.caustics.emplace();
        request_ = caustics;
        is_of_caustics_ = true;
        begin_tracing();
    }
    void build()
    {
        photons<B> p = std::move(built_.trace.photons);
        if (gathers(settings_) && built_.has_caustics_apart) // all photons are the gather's alone
            gather_.emplace(device_, built_.scene(), std::exchange(p, no_photons()), settings_);
        else if (gathers(settings_))
            gather_.emplace(device_, built_.scene(), detail::copy(device_, p), settings_);
        const uint parts = built_.has_caustics_apart ? every_part : parts_at_ends(settings_);
        const auto builder = settings_.map.builder;
        built_.map = map_of(std::move(p), parts, settings_.estimate.k, builder);
        // Caustics crowd in few cells, where a photon that has a slot would stand for more than an estimate seeks.
        if (built_.caustics)
            built_.caustics->map = map_of(std::move(built_.caustics->trace.photons), every_part,
                settings_.estimate.sought(true), builder == map_builder::route ? map_builder::sort : builder);
        auto& made = built_.stats.map;
        made.builder = settings_.map.builder;
        if (made.builder == map_builder::automatic)
            made.builder = built_.map.has_blocks() ? map_builder::blocks : map_builder::sort;
        made.blocks = detail::block_count(built_.map.in_blocks);
        made.cells = cell_count(built_.map.cells_of);
        made.resolution = glm::uvec3(built_.map.cells_of.resolution);
        made.overflowing_cells = built_.map.overflowing_cells;
        made.left_out = built_.map.left_out;
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
            : routed_map(device_, std::move(p), g, m.slots, settings_.seed, parts, m.surplus);
    }

    B& device_;
    render_settings settings_;
    photon_request request_;      // that is traced
    bool is_of_caustics_ = false; // it is that of the caustic photons
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
    pass_radii<B> radii{.first = {&first.map, settings.estimate.k}, .share2 = shrunk_share2(pass)};
    if (first.caustics)
        radii.first_of_caustics = {&first.caustics->map, settings.estimate.sought(true)};
    return radii;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
