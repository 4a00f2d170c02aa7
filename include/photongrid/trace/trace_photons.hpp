// Photon tracing (section 2.1), in batches of paths (photon_frames.hpp). No photons are read back: the host learns the
// progress from two counts per batch, by occlusion query. Of pilot paths, if there are any, it reads which are useful.
#pragma once

#include <photongrid/core/copy_vectors.kernel.hpp>
#include <photongrid/map/map_buffers.hpp>
#include <photongrid/map/prefix_sums.hpp>
#include <photongrid/trace/divide_power.kernel.hpp>
#include <photongrid/trace/gather_normal.kernel.hpp>
#include <photongrid/trace/gather_photon.kernel.hpp>
#include <photongrid/trace/is_found.kernel.hpp>
#include <photongrid/trace/path_is_emitted.kernel.hpp>
#include <photongrid/trace/photon_stats.hpp>
#include <photongrid/trace/pilot_tracing.hpp>
#include <photongrid/trace/render_observer.hpp>
#include <photongrid/trace/tally_path.kernel.hpp>

#include <bit>
#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The stored photons and the counts of all paths.
template <backend B>
struct traced_photons {
    photongrid::photons<B> photons;     ///< in the order of (path, bounce)
    std::uint64_t asked = 0;            ///< photons of the request
    std::uint64_t emitted = 0;          ///< paths, from the lights
    std::uint64_t stored = 0;           ///< photons
    std::uint64_t dropped = 0;          ///< diffuse hits of the last path beyond the requested number of photons
    std::vector<path_tally<B>> tallies; ///< one per batch of paths
};

/// Photon tracing in batches, which can be interrupted between batches. It emits paths in id order until the requested
/// photons are stored, in the order of (path, bounce), or the most paths are emitted that the request allows: under a
/// bulb over a bare floor nothing is stored. The powers are divided by the number of emitted paths. Positions
/// have w = 1 for caustic photons (light_part). Normals are stored only for a final gather or for a leak policy that
/// needs them.
template <backend B>
class photon_tracing {
public:
    /// It traces nothing yet. `device` and `uploaded` must outlive it.
    photon_tracing(B& device, const device_scene<B>& uploaded, const render_settings& settings,
        const photon_request& request, const emission_guide& guide)
        : device_(device), scene_(uploaded), settings_(settings), request_(request), wanted_(request.photons),
          most_paths_(detail::most_paths(device.caps(), settings.map.photon_depth)),
          guide_(detail::upload_some(device, guide.records()))
    {
        t_.asked = wanted_;
        make_photons();
        make_frames(wanted_ / 2 + 1);
    }
    /// With the request of the settings, by even emission whatever they say.
    photon_tracing(B& device, const device_scene<B>& uploaded, const render_settings& settings)
        : photon_tracing(device, uploaded, settings, request_of(settings, uploaded.layout), {})
    {
    }

    photon_tracing(B&, const device_scene<B>&&, const render_settings&) = delete; // it keeps a reference
    photon_tracing(B&, const device_scene<B>&&, const render_settings&, const photon_request&, const emission_guide&)
        = delete;

    /// Whether all photons are stored, or the most paths emitted.
    bool finished() const { return stored_ == wanted_; }
    /// The fraction of the requested photons that are stored.
    double fraction() const { return wanted_ == 0 ? 1.0 : static_cast<double>(stored_) / wanted_; }

    /// Traces one more batch of paths.
    /// \throws backend_error.
    void advance();

    /// The photons, after tracing has finished.
    traced_photons<B> take() { return std::move(t_); }

private:
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
    /// Ends tracing with the photons that are stored.
    void end_early();

    B& device_;
    const device_scene<B>& scene_;
    render_settings settings_;
    photon_request request_;
    uint wanted_; // photons
    uint most_paths_;
    uint paths_ = 0; // per batch
    std::optional<detail::photon_frames<B>> frames_;
    buffer_of<B, glm::vec4> guide_;
    traced_photons<B> t_;
    uint stored_ = 0;
};

// Defined outside the class: functions defined inside are implicitly inline, and `extern template` does not suppress
// them.

template <backend B>
void photon_tracing<B>::advance()
{
    if (finished())
        return;
    const uint missing = wanted_ - stored_;
    if (t_.emitted > 0) // where few paths store a photon, a batch needs more of them
        make_frames(std::uint64_t{missing} * t_.emitted / std::max(stored_, 1u) * 33 / 32);
    const auto paths = static_cast<uint>(std::min<std::uint64_t>(paths_, request_.most_paths - t_.emitted));
    const uint frames = trace_batch(device_, scene_, *frames_,
        path_batch<B>{paths, static_cast<uint>(t_.emitted), request_.ends, &guide_}, settings_);

    auto storable = device_.template make<uint>(paths);
    path_tally<B> tally{device_.template make<glm::uvec4>(paths), device_.template make<glm::uvec4>(paths)};
    device_.template run<kernels::tally_path>(paths, {.paths = paths, .frames = frames, .kinds = request_.kinds},
        reads(frames_->positions), writes(storable, tally.ends, tally.hits));
    const auto sums = prefix_sums(device_, storable);

    const uint emitted
        = detail::checked_count<kernels::path_is_emitted>(device_, paths, {.photons = missing}, reads(sums, storable));
    if (emitted == 0) // the first path always is; otherwise tracing would never end
        throw backend_error(device_.caps().backend + ": count<path_is_emitted>: the device returned 0; at least 1 of "
            + std::to_string(paths) + " paths is emitted");
    // A path stores at most one photon per bounce, and only the last of these paths exceeds the requested number.
    const auto found = detail::checked_count<kernels::is_found>(
        device_, std::size_t{missing} + settings_.map.photon_depth, {.emitted = emitted}, reads(sums));
    const uint taken = std::min(found, missing);
    device_.template run<kernels::gather_photon>({taken, stored_},
        {.paths = paths, .frames = frames, .stored_before = stored_, .kinds = request_.kinds},
        reads(sums, frames_->positions, frames_->powers, frames_->directions),
        writes(t_.photons.positions, t_.photons.powers, t_.photons.directions));
    if (keeps_normals(settings_))
        device_.template run<kernels::gather_normal>({taken, stored_, scene_.layout.features},
            {.paths = paths, .frames = frames, .stored_before = stored_, .kinds = request_.kinds},
            reads(sums, frames_->positions, frames_->powers, frames_->next_origins, frames_->next_directions),
            writes(t_.photons.normals));
    t_.tallies.push_back(detail::sum_tally(device_, std::move(tally), emitted));
    t_.dropped += found - taken;
    t_.emitted += emitted;
    stored_ += taken;
    t_.stored = stored_;
    if (t_.emitted >= request_.most_paths)
        end_early();
    if (finished())
        device_.template run<kernels::divide_power>(
            wanted_, {.share = 1.0f / static_cast<float>(t_.emitted)}, reads(), writes(t_.photons.powers));
}

template <backend B>
void photon_tracing<B>::end_early()
{
    auto found = std::exchange(t_.photons, {});
    wanted_ = stored_;
    make_photons();
    const auto keep = [&](const buffer_of<B, glm::vec4>& from, buffer_of<B, glm::vec4>& to) {
        device_.template run<kernels::copy_vectors>(to.size(), {}, reads(from), writes(to));
    };
    keep(found.positions, t_.photons.positions);
    keep(found.powers, t_.photons.powers);
    keep(found.directions, t_.photons.directions);
    if (keeps_normals(settings_))
        keep(found.normals, t_.photons.normals);
}

/// Traces all photons that the settings ask for but those of a map of caustic photons (photon_tracing).
/// \throws backend_error, render_cancelled.
template <backend B>
traced_photons<B> trace_photons(
    B& device, const device_scene<B>& uploaded, const render_settings& settings, const render_observer& observer = {})
{
    const auto stop_if_cancelled = [&] {
        if (observer.cancelled && observer.cancelled())
            throw render_cancelled();
    };
    const auto request = request_of(settings, uploaded.layout);
    emission_guide guide;
    if (is_guided(settings, request)) {
        pilot_tracing<B> pilot(device, uploaded, settings, request);
        do
            stop_if_cancelled();
        while (!pilot.advance());
        guide = pilot.guide();
    }
    photon_tracing<B> tracing(device, uploaded, settings, request, guide);
    while (!tracing.finished()) {
        stop_if_cancelled();
        tracing.advance();
        if (observer.progress)
            observer.progress("trace_photons", tracing.fraction());
    }
    return tracing.take();
}

/// The counts of all paths and hits. Reads the tallies back.
template <backend B>
photon_stats count_photons(B& device, const traced_photons<B>& t)
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
        p.left_to_caustics += hits.z;
    }
    p.asked = t.asked;
    p.emitted = t.emitted;
    p.stored = t.stored;
    p.dropped = t.dropped;
    return p;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
