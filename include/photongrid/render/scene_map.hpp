// Builds a scene's photon map (figure 1, left): traces photons and puts them into a map. It runs again only if
// geometry, materials, lights or a setting that same_map() compares changes.
#pragma once

#include <photongrid/map/map_builders.hpp>
#include <photongrid/render/final_gather.hpp>
#include <photongrid/render/stage_clock.hpp>
#include <photongrid/trace/trace_photons.hpp>

#include <optional>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// The result of build_map and the input of draw: the scene on the device and its photon map.
template <backend B>
struct built_map {
    device_scene<B> scene;               ///< recentred
    map_buffers<B> map;                  ///< in the coordinates of `scene`; with gather rays of caustic photons alone
    traced_photons<B> trace;             ///< without the photons, which are in `map`
    render_stats stats;                  ///< trace_photons, build_map and map
    std::optional<gather_map<B>> gather; ///< of all photons, for a final gather
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
/// Whether the irradiance at photons is the same with settings `a` and `b` of the estimate, for a final gather.
inline bool same_irradiance(estimate_settings a, const estimate_settings& b)
{
    a.gather_rays = b.gather_rays;
    a.radii = b.radii;
    return a == b;
}

/// Whether the photon map of scene `a` with settings `as` can be used for scene `b` with `bs`: same shapes, materials
/// and lights, and the same photons in the same map. Cameras, names and the settings of other stages do not matter.
inline bool same_map(const scene& a, const render_settings& as, const scene& b, const render_settings& bs)
{
    const bool fitted = !as.map.has_given_grid() && as.map.builder != map_builder::blocks;
    return same_light_paths(a, b) && as.seed == bs.seed && as.map.in_use() == bs.map.in_use()
        && (!fitted || as.estimate.k == bs.estimate.k) // a fitted map depends on k
        && (as.estimate.leaks.needs_photon_normals() || !bs.estimate.leaks.needs_photon_normals())
        && parts_of(as.output.only) == parts_of(bs.output.only) && parts_at_ends(as) == parts_at_ends(bs)
        && gathers(as) == gathers(bs) && (!gathers(as) || same_irradiance(as.estimate, bs.estimate))
        && (as.output.only != light_part::direct || bs.output.only == light_part::direct); // it has no photons
}

/// Builds a photon map batch by batch, so that it can be interrupted.
template <backend B>
class map_building {
public:
    /// Uploads the scene. It traces nothing yet. In a scene that has no indirect light the map has no photons, unless
    /// that is an error for the caller.
    /// \throws std::invalid_argument for a scene or settings that check() rejects, backend_error.
    map_building(
        B& device, const scene& s, const render_settings& settings, if_none_stored none = if_none_stored::trace_none)
        : device_(device), settings_(settings)
    {
        check(settings);
        built_.scene = upload_scene(device, s);
        detail::stage_clock<B> clock(device, built_.stats.trace_photons);
        tracing_.emplace(device, s, built_.scene, settings, none);
        clock.stop();
    }
    map_building(const map_building&) = delete;
    map_building& operator=(const map_building&) = delete;

    /// Traces one more batch of photon paths; returns whether all photons are stored (2.1).
    /// \throws std::runtime_error if the lights store too few photons, backend_error.
    bool trace_photons()
    {
        if (!tracing_)
            return true;
        detail::time_stage(device_, built_.stats.trace_photons, [&] { tracing_->advance(); });
        return tracing_->finished();
    }
    /// Builds the map of the photons (2.2) in one step. Returns true.
    /// \throws backend_error.
    bool build_map()
    {
        if (tracing_) {
            built_.trace = tracing_->take();
            tracing_.reset();
            detail::time_stage(device_, built_.stats.build_map, [&] { build(); });
        }
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
    bool finished() const { return !tracing_ && !gather_; }
    /// The fraction of the photons that have been traced.
    double fraction() const { return tracing_ ? tracing_->fraction() : 1.0; }

    /// The finished map.
    built_map<B> take() { return std::move(built_); }

private:
    void build()
    {
        photons<B> p = std::move(built_.trace.photons);
        if (gathers(settings_))
            gather_.emplace(device_, built_.scene, detail::copy(device_, p), settings_);
        built_.map = map_of(std::move(p), parts_at_ends(settings_));
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

    map_buffers<B> map_of(photons<B> p, uint parts)
    {
        const auto& m = settings_.map;
        const uint k = settings_.estimate.k;
        switch (m.builder) {
        case map_builder::blocks: return block_map(device_, std::move(p), parts);
        case map_builder::automatic: return fitted_map(device_, std::move(p), k, parts);
        case map_builder::sort:
        case map_builder::route: break;
        }
        const auto& layout = built_.scene.layout;
        const grid g = m.has_given_grid() ? make_grid(layout.low, layout.high, m.grid)
                                          : fitting_grid(device_, p, k, device_.caps().cells_per_radius);
        return m.builder == map_builder::sort
            ? sorted_map(device_, std::move(p), g, parts)
            : routed_map(device_, std::move(p), g, m.slots, settings_.seed, parts, m.surplus);
    }

    B& device_;
    render_settings settings_;
    built_map<B> built_;
    std::optional<photon_tracing<B>> tracing_;     // of built_.scene
    std::optional<gather_map_building<B>> gather_; // of built_.scene
};

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
