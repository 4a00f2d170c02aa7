// Photon tracing (section 2.1), breadth-first: each pass traces one bounce of all paths of a batch into a new frame of
// the photon texture. No pixels are read back: the host learns the progress from two counts per batch, by occlusion
// query.
#pragma once

#include <photongrid/map/map_buffers.hpp>
#include <photongrid/map/prefix_sums.hpp>
#include <photongrid/trace/bounce_photon.kernel.hpp>
#include <photongrid/trace/device_scene.hpp>
#include <photongrid/trace/divide_power.kernel.hpp>
#include <photongrid/trace/emit_photon.kernel.hpp>
#include <photongrid/trace/gather_normal.kernel.hpp>
#include <photongrid/trace/gather_photon.kernel.hpp>
#include <photongrid/trace/is_found.kernel.hpp>
#include <photongrid/trace/mesh_search.hpp>
#include <photongrid/trace/path_goes_on.kernel.hpp>
#include <photongrid/trace/path_is_emitted.kernel.hpp>
#include <photongrid/trace/photon_stats.hpp>
#include <photongrid/trace/photon_to_search.kernel.hpp>
#include <photongrid/trace/render_observer.hpp>
#include <photongrid/trace/sum_tallies.kernel.hpp>
#include <photongrid/trace/tally_path.kernel.hpp>

#include <bit>
#include <optional>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// Sums over paths, on the device, in buffers of one element.
template <backend B>
struct path_tally {
    buffer_of<B, glm::uvec4> ends; ///< absorbed, escaped, cut off, invalid
    buffer_of<B, glm::uvec4> hits; ///< diffuse hits; those left to the direct light
};

/// The stored photons and the counts of all paths.
template <backend B>
struct traced_photons {
    photongrid::photons<B> photons;     ///< in the order of (path, bounce)
    std::uint64_t emitted = 0;          ///< paths, from the lights
    std::uint64_t dropped = 0;          ///< diffuse hits of the last path beyond the requested number of photons
    std::vector<path_tally<B>> tallies; ///< one per batch of paths
};

namespace detail {
    /// The frames of the photon texture: frame f of path p is element f * paths + p.
    template <backend B>
    struct photon_frames {
        buffer_of<B, glm::vec4> positions, powers, directions, next_origins, next_directions;

        photon_frames(B& device, std::size_t n)
            : positions(device.template make<glm::vec4>(n)), powers(device.template make<glm::vec4>(n)),
              directions(device.template make<glm::vec4>(n)), next_origins(device.template make<glm::vec4>(n)),
              next_directions(device.template make<glm::vec4>(n))
        {
        }
    };

    /// Sums the first `n` tallies.
    template <backend B>
    path_tally<B> sum_tally(B& device, path_tally<B> t, uint n)
    {
        do {
            const uint groups = (n + 15) / 16;
            path_tally<B> sums{device.template make<glm::uvec4>(groups), device.template make<glm::uvec4>(groups)};
            device.template run<kernels::sum_tallies>(
                groups, {.terms = n}, reads(t.ends, t.hits), writes(sums.ends, sums.hits));
            t = std::move(sums);
            n = groups;
        } while (n > 1);
        return t;
    }

    /// The most paths of a batch. A GPU needs many to be busy; on a CPU more only take memory.
    inline uint most_paths(const capabilities& caps, uint photon_depth)
    {
        if (caps.software)
            return 32768;
        constexpr std::size_t bytes = std::size_t{1} << 29; // of all frames
        return static_cast<uint>(std::bit_floor(bytes / (5 * sizeof(glm::vec4) * (std::size_t{photon_depth} + 1))));
    }

    /// trace_batch by a pass for each bounce.
    template <backend B>
    uint trace_batch_by_passes(B& device, const device_scene<B>& s, photon_frames<B>& f, uint paths, uint first,
        const render_settings& settings)
    {
        const auto& layout = s.layout;
        mesh_hits<B> hits(device, s, paths);
        mesh_rays<B> rays(device, s.has_meshes() ? paths : 0);
        device.template run<kernels::emit_photon>({paths, 0u, layout.features},
            {.first_path = first, .seed = settings.seed}, inputs_of_emission(s),
            writes(f.positions, f.powers, f.directions, f.next_origins, f.next_directions));
        uint frame = 1;
        for (; frame <= settings.map.photon_depth; ++frame) {
            if (s.has_meshes()) {
                device.template run<kernels::photon_to_search>(paths, {.first = (frame - 1) * paths},
                    reads(f.positions, f.next_origins, f.next_directions), writes(rays.origins, rays.directions));
                rays.find(device, s, hits);
            }
            device.template run<kernels::bounce_photon>({paths, frame * paths, layout.features},
                {.paths = paths, .first_path = first, .last_frame = settings.map.photon_depth, .seed = settings.seed},
                reads(s.records, f.positions, f.powers, f.directions, f.next_origins, f.next_directions, hits.places,
                    hits.normals, hits.shadings, hits.colors),
                writes(f.positions, f.powers, f.directions, f.next_origins, f.next_directions));
            if (frame % 8 == 0
                && checked_count<kernels::path_goes_on>(device, {paths, frame * paths}, {}, reads(f.positions)) == 0)
                return frame + 1;
        }
        return frame;
    }
} // namespace detail

/// Traces `paths` paths from id `first` on, and returns the number of frames. Every 8 bounces it counts the paths that
/// are still active, and stops if there are none.
template <backend B>
uint trace_batch(B& device, const device_scene<B>& s, detail::photon_frames<B>& f, uint paths, uint first,
    const render_settings& settings)
{
    return detail::trace_batch_by_passes(device, s, f, paths, first, settings);
}

/// Whether a scene has surfaces that may make caustics.
inline bool may_have_caustics(const scene_layout& layout)
{
    return (layout.features & (has_mirrors | has_glass | has_rough | has_coats)) != 0;
}

/// What photon tracing does in a scene where no path stores a photon, as under a bulb over a bare floor.
enum class if_none_stored { fail, trace_none };

/// Photon tracing in batches, which can be interrupted between batches. It emits paths in id order until map.photons
/// photons are stored, in the order of (path, bounce); for a picture of direct light alone it emits none. The powers
/// are divided by the number of emitted paths. Positions have w = 1 for caustic photons (light_part). Photons straight
/// from a light are stored only for a final gather, normals only for that or for a leak policy that needs them.
template <backend B>
class photon_tracing {
public:
    /// It traces nothing yet. `device` and `uploaded` must outlive it.
    photon_tracing(B& device, const scene& s, const device_scene<B>& uploaded, const render_settings& settings,
        if_none_stored none = if_none_stored::fail)
        : device_(device), scene_(uploaded), settings_(settings), lights_(detail::names_of_lights(s)), none_(none),
          wanted_(settings.output.only == light_part::direct
                      || (follows_paths(settings) && !may_have_caustics(uploaded.layout))
                  ? 0u
                  : settings.map.photons),
          most_paths_(detail::most_paths(device.caps(), settings.map.photon_depth))
    {
        make_photons();
        make_frames(wanted_ / 2 + 1);
    }

    photon_tracing(B&, const scene&, const device_scene<B>&&, const render_settings&) = delete; // it keeps a reference

    /// Whether all photons are stored.
    bool finished() const { return stored_ == wanted_; }
    /// The fraction of the requested photons that are stored.
    double fraction() const { return wanted_ == 0 ? 1.0 : static_cast<double>(stored_) / wanted_; }

    /// Traces one more batch of paths.
    /// \throws std::runtime_error, with the names of the lights, if paths store so few photons that tracing would not
    ///         end.
    void advance();

    /// The photons, after tracing has finished.
    traced_photons<B> take() { return std::move(t_); }

private:
    /// As kernels read it.
    uint first_hits() const { return gathers(settings_) ? 1u : 0u; }
    void make_photons()
    {
        const auto make = [&] { return device_.template make<glm::vec4>(wanted_); };
        t_.photons = {make(), make(), make(), {}};
        if (keeps_normals(settings_))
            t_.photons.normals = make();
    }
    /// Makes room for at least so many paths, or as many as a batch may have.
    void make_frames(std::uint64_t paths)
    {
        const uint enough = static_cast<uint>(std::bit_ceil(std::clamp<std::uint64_t>(paths, 1024, most_paths_)));
        if (enough <= paths_)
            return;
        frames_.reset();
        frames_.emplace(device_, std::size_t{enough} * (settings_.map.photon_depth + 1));
        paths_ = enough;
    }
    /// Ends tracing if so many paths have stored no photon that none will.
    void stop_if_none_are_stored()
    {
        const std::uint64_t most_paths
            = std::min<std::uint64_t>(std::uint64_t{wanted_} * 4096 + (1u << 20), 0xFFFF0000u);
        const bool none = stored_ == 0 && t_.emitted >= (1u << 22);
        if (none && none_ == if_none_stored::trace_none) {
            wanted_ = 0;
            make_photons();
        } else if (none || t_.emitted >= most_paths) {
            throw std::runtime_error("trace_photons: " + std::to_string(t_.emitted) + " paths from " + lights_
                + " stored " + std::to_string(stored_) + " of the " + std::to_string(wanted_) + " photons requested. "
                + (gathers(settings_) ? "Check that the lights reach a diffuse surface"
                                      : "Only indirect light is stored: check that the lights reach a mirror, glass, "
                                        "or a second diffuse surface"));
        }
    }

    B& device_;
    const device_scene<B>& scene_;
    render_settings settings_;
    std::string lights_;
    if_none_stored none_;
    uint wanted_; // photons
    uint most_paths_;
    uint paths_ = 0; // per batch
    std::optional<detail::photon_frames<B>> frames_;
    traced_photons<B> t_;
    uint stored_ = 0;
};

// Defined outside the class: functions defined inside are implicitly inline, and `extern template` does not suppress
// them.

template <backend B>
void photon_tracing<B>::advance()
{
    if (!finished())
        stop_if_none_are_stored();
    if (finished())
        return;
    const uint missing = wanted_ - stored_;
    if (t_.emitted > 0) // where few paths store a photon, a batch needs more of them
        make_frames(std::uint64_t{missing} * t_.emitted / std::max(stored_, 1u) * 33 / 32);
    const uint frames = trace_batch(device_, scene_, *frames_, paths_, static_cast<uint>(t_.emitted), settings_);

    auto storable = device_.template make<uint>(paths_);
    path_tally<B> tally{device_.template make<glm::uvec4>(paths_), device_.template make<glm::uvec4>(paths_)};
    device_.template run<kernels::tally_path>(paths_, {.paths = paths_, .frames = frames, .first_hits = first_hits()},
        reads(frames_->positions), writes(storable, tally.ends, tally.hits));
    const auto sums = prefix_sums(device_, storable);

    const uint emitted
        = detail::checked_count<kernels::path_is_emitted>(device_, paths_, {.photons = missing}, reads(sums, storable));
    if (emitted == 0) // the first path always is; otherwise tracing would never end
        throw backend_error(device_.caps().backend + ": count<path_is_emitted>: the device returned 0; at least 1 of "
            + std::to_string(paths_) + " paths is emitted");
    // A path stores at most one photon per bounce, and only the last of these paths exceeds the requested number.
    const auto found = detail::checked_count<kernels::is_found>(
        device_, std::size_t{missing} + settings_.map.photon_depth, {.emitted = emitted}, reads(sums));
    const uint taken = std::min(found, missing);
    device_.template run<kernels::gather_photon>({taken, stored_},
        {.paths = paths_, .frames = frames, .stored_before = stored_, .first_hits = first_hits()},
        reads(sums, frames_->positions, frames_->powers, frames_->directions),
        writes(t_.photons.positions, t_.photons.powers, t_.photons.directions));
    if (keeps_normals(settings_))
        device_.template run<kernels::gather_normal>({taken, stored_},
            {.paths = paths_, .frames = frames, .stored_before = stored_, .first_hits = first_hits()},
            reads(sums, frames_->positions, frames_->powers, frames_->next_origins, frames_->next_directions),
            writes(t_.photons.normals));
    t_.tallies.push_back(detail::sum_tally(device_, std::move(tally), emitted));
    t_.dropped += found - taken;
    t_.emitted += emitted;
    stored_ += taken;
    if (finished())
        device_.template run<kernels::divide_power>(
            wanted_, {.share = 1.0f / static_cast<float>(t_.emitted)}, reads(), writes(t_.photons.powers));
}

/// Traces all photons (photon_tracing).
/// \throws std::runtime_error as photon_tracing::advance does, render_cancelled.
template <backend B>
traced_photons<B> trace_photons(B& device, const scene& s, const device_scene<B>& uploaded,
    const render_settings& settings, const render_observer& observer = {})
{
    photon_tracing<B> tracing(device, s, uploaded, settings);
    while (!tracing.finished()) {
        if (observer.cancelled && observer.cancelled())
            throw render_cancelled();
        tracing.advance();
        if (observer.progress)
            observer.progress("trace_photons", tracing.fraction());
    }
    return tracing.take();
}

/// The counts of all paths and hits, `stored` of which are in the map. Reads the tallies back.
template <backend B>
photon_stats count_photons(B& device, const traced_photons<B>& t, std::uint64_t stored)
{
    photon_stats p;
    for (const auto& tally : t.tallies) {
        const auto ends = device.download(tally.ends).at(0);
        const auto hits = device.download(tally.hits).at(0);
        p.absorbed += ends.x;
        p.escaped += ends.y;
        p.cut_off += ends.z;
        p.invalid += ends.w;
        p.diffuse_hits += hits.x;
        p.direct += hits.y;
    }
    p.emitted = t.emitted;
    p.stored = stored;
    p.dropped = t.dropped;
    return p;
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
