// Photon tracing (section 2.1), breadth-first: all paths of a batch take one bounce a pass, each bounce into its own frame
// of the photon texture. No pixel is read back: two counts a batch, by occlusion query, tell the host how far it is.
#pragma once

#include <photongrid/device_scene.hpp>
#include <photongrid/photon_map.hpp>
#include <photongrid/prefix_sums.hpp>
#include <photongrid/render_stats.hpp>
#include <photongrid/trace_kernels.hpp>

#include <bit>

namespace photongrid {

/// Sums over paths, one element each, still on the device.
template <backend B>
struct path_tally {
    buffer_of<B, glm::uvec4> ends; ///< absorbed, escaped, cut off, invalid
    buffer_of<B, glm::uvec4> hits; ///< diffuse hits, of them straight from a light
};

/// Photons stored, and what became of every path.
template <backend B>
struct traced_photons {
    photongrid::photons<B> photons;     ///< in the order of (path, bounce)
    std::uint64_t emitted = 0;          ///< paths, from the lights
    std::uint64_t dropped = 0;          ///< diffuse hits of the last path beyond the photons asked for
    std::vector<path_tally<B>> tallies; ///< one a batch of paths, of one element each
};

namespace detail {
    /// The frames of the photon texture: frame f of path p is element f * paths + p.
    template <backend B>
    struct photon_frames {
        buffer_of<B, glm::vec4> positions, powers, directions, next_origins, next_directions;

        photon_frames(B& b, std::size_t n)
            : positions(b.template make<glm::vec4>(n)), powers(b.template make<glm::vec4>(n)), directions(b.template make<glm::vec4>(n)),
              next_origins(b.template make<glm::vec4>(n)), next_directions(b.template make<glm::vec4>(n)) {}
    };

    /// The sums of the first `n` tallies.
    template <backend B>
    path_tally<B> sum_tally(B& b, path_tally<B> t, uint n)
    {
        do {
            const uint groups = (n + 15) / 16;
            path_tally<B> sums{b.template make<glm::uvec4>(groups), b.template make<glm::uvec4>(groups)};
            b.template run<kernels::sum_tallies>(groups, {.terms = n}, reads(t.ends, t.hits), writes(sums.ends, sums.hits));
            t = std::move(sums);
            n = groups;
        } while (n > 1);
        return t;
    }

    inline std::string light_names(const scene& s)
    {
        std::string names;
        const auto add = [&](const auto& lights) {
            for (const auto& l : lights)
                names += (names.empty() ? "'" : ", '") + l.name + "'";
        };
        add(s.rectangle_lights);
        add(s.point_lights);
        return names;
    }
} // namespace detail

/// Traces `paths` paths from id `first` on; returns the frames used. Asks now and then whether any path goes on.
template <backend B>
uint trace_batch(B& b, const device_scene<B>& s, detail::photon_frames<B>& f, uint paths, uint first, const render_settings& settings)
{
    const auto& about = s.about;
    b.template run<kernels::emit_photon>({paths, 0u, about.features}, {.scene_layout = about.layout, .first_path = first, .seed = settings.seed}, reads(s.records),
        writes(f.positions, f.powers, f.directions, f.next_origins, f.next_directions));
    uint frame = 1;
    for (; frame <= settings.photon_depth; ++frame) {
        b.template run<kernels::bounce_photon>({paths, frame * paths, about.features},
            {.scene_layout = about.layout, .paths = paths, .first_path = first, .last_frame = settings.photon_depth, .seed = settings.seed},
            reads(s.records, f.positions, f.powers, f.directions, f.next_origins, f.next_directions),
            writes(f.positions, f.powers, f.directions, f.next_origins, f.next_directions));
        if (frame % 8 == 0 && detail::checked_count<kernels::path_goes_on>(b, {paths, frame * paths}, {}, reads(f.positions)) == 0)
            return frame + 1;
    }
    return frame;
}

/// Emits paths in id order until settings.photons photons are stored; photon order is (path, bounce). Each photon's power
/// is the lights' power divided by the paths emitted. Positions' w is 1 for caustic photons (light_part). Normals are kept
/// only where the leak policy asks for them.
/// \throws std::runtime_error when so few photons are stored that it would not end, naming the lights.
template <backend B>
traced_photons<B> trace_photons(B& b, const scene& s, const device_scene<B>& device, const render_settings& settings, const render_observer& observer = {})
{
    const uint wanted = settings.photons;
    const uint paths = std::clamp(std::bit_ceil(wanted / 2 + 1), 1024u, 32768u);
    const std::uint64_t most_paths = std::min<std::uint64_t>(std::uint64_t{wanted} * 4096 + (1u << 20), 0xFFFF0000u);
    traced_photons<B> t;
    t.photons = {b.template make<glm::vec4>(wanted), b.template make<glm::vec4>(wanted), b.template make<glm::vec4>(wanted), {}};
    if (settings.leaks.needs_normals())
        t.photons.normals = b.template make<glm::vec4>(wanted);
    detail::photon_frames<B> f(b, std::size_t{paths} * (settings.photon_depth + 1));

    uint stored = 0;
    while (stored < wanted) {
        if (observer.cancelled && observer.cancelled())
            throw render_cancelled();
        if (t.emitted >= most_paths || (stored == 0 && t.emitted >= (1u << 22)))
            throw std::runtime_error("trace_photons: " + std::to_string(t.emitted) + " paths from " + detail::light_names(s) + " stored " + std::to_string(stored) + " of the "
                + std::to_string(wanted) + " photons asked for. Stored are diffuse hits that come not straight from a light: does the light reach a mirror, glass, or a second diffuse surface?");
        const uint first = static_cast<uint>(t.emitted);
        const uint frames = trace_batch(b, device, f, paths, first, settings);

        auto storable = b.template make<uint>(paths);
        path_tally<B> tally{b.template make<glm::uvec4>(paths), b.template make<glm::uvec4>(paths)};
        b.template run<kernels::tally_path>(paths, {.paths = paths, .frames = frames}, reads(f.positions), writes(storable, tally.ends, tally.hits));
        const auto sums = prefix_sums(b, storable);

        const uint emitted = detail::checked_count<kernels::path_is_emitted>(b, paths, {.wanted = wanted - stored}, reads(sums, storable));
        if (emitted == 0) // the first always is; believing it would mean tracing for ever
            throw backend_error(b.caps().backend + ": count<path_is_emitted>: the device returned 0; at least 1 of " + std::to_string(paths) + " paths is emitted");
        // No path stores more photons than it takes bounces, and the last of these is the first to have stored what is wanted.
        const auto found = detail::checked_count<kernels::is_found>(b, std::size_t{wanted} - stored + settings.photon_depth, {.emitted = emitted}, reads(sums));
        const uint taken = std::min(found, wanted - stored);
        b.template run<kernels::gather_photon>({taken, stored}, {.paths = paths, .frames = frames, .stored_before = stored}, reads(sums, f.positions, f.powers, f.directions),
            writes(t.photons.positions, t.photons.powers, t.photons.directions));
        if (settings.leaks.needs_normals())
            b.template run<kernels::gather_normal>({taken, stored}, {.paths = paths, .frames = frames, .stored_before = stored},
                reads(sums, f.positions, f.powers, f.next_origins, f.next_directions), writes(t.photons.normals));
        t.tallies.push_back(detail::sum_tally(b, std::move(tally), emitted));
        t.dropped += found - taken;
        t.emitted += emitted;
        stored += taken;
        if (observer.progress)
            observer.progress("trace_photons", static_cast<double>(stored) / wanted);
    }
    b.template run<kernels::divide_power>(wanted, {.share = 1.0f / static_cast<float>(t.emitted)}, reads(), writes(t.photons.powers));
    return t;
}

/// The account of all paths and hits, `stored` of which are in the map; reads the tallies back.
template <backend B>
photon_stats count_photons(B& b, const traced_photons<B>& t, std::uint64_t stored)
{
    photon_stats p;
    for (const auto& tally : t.tallies) {
        const auto ends = b.download(tally.ends).at(0);
        const auto hits = b.download(tally.hits).at(0);
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
