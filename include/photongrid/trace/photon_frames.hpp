// Batches of photon paths (section 2.1), traced breadth-first: each pass traces one bounce of all paths of a batch into
// a new frame of the photon texture.
#pragma once

#include <photongrid/trace/bounce_photon.kernel.hpp>
#include <photongrid/trace/device_scene.hpp>
#include <photongrid/trace/emission_guide.kernel.hpp>
#include <photongrid/trace/emit_photon.kernel.hpp>
#include <photongrid/trace/mesh_search.hpp>
#include <photongrid/trace/path_goes_on.kernel.hpp>
#include <photongrid/trace/photon_event.kernel.hpp>
#include <photongrid/trace/photon_to_search.kernel.hpp>
#include <photongrid/trace/sum_tallies.kernel.hpp>

#include <bit>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Sums over paths, on the device, in buffers of one element.
template <backend B>
struct path_tally {
    buffer_of<B, glm::uvec4> ends; ///< absorbed, escaped, cut off, invalid
    buffer_of<B, glm::uvec4> hits; ///< diffuse hits; those left to the direct light, or to a map of caustic photons
};

/// A batch of paths to trace.
template <backend B>
struct path_batch {
    uint paths = 0;
    uint first = 0;                                 ///< id of the first path
    uint ends = kernels::NOTHING_ENDS;              ///< what ends paths besides absorption (photon_event.glsl)
    const buffer_of<B, glm::vec4>* guide = nullptr; ///< records of the emission guide, if there is one
};

namespace detail {
    /// The frames of the photon texture: frame f of path p is element f * paths + p. What follows the end of a path is
    /// undefined.
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

    /// The most paths of a batch: those with which the device is fastest, if there is memory for their frames.
    inline uint most_paths(const capabilities& caps, uint photon_depth)
    {
        constexpr std::size_t bytes = std::size_t{1} << 29; // of all frames
        const std::size_t path_bytes = 5 * sizeof(glm::vec4) * (std::size_t{photon_depth} + 1);
        return std::min(caps.photon_batch, static_cast<uint>(std::bit_floor(bytes / path_bytes)));
    }

    /// Frame 0 of a batch.
    template <backend B>
    void emit_photons(B& device, const device_scene<B>& s, photon_frames<B>& f, const path_batch<B>& batch, uint seed)
    {
        const std::size_t vectors = batch.guide != nullptr ? batch.guide->size() : 0; // fewer than a box's: no boxes
        device.template run<kernels::emit_photon>({batch.paths, 0u, s.layout.features},
            {.first_path = batch.first,
                .seed = seed,
                .boxes = static_cast<uint>(vectors / kernels::VECTORS_PER_EMISSION_BOX),
                .ends = batch.ends},
            inputs_of_emission(s, batch.guide),
            writes(f.positions, f.powers, f.directions, f.next_origins, f.next_directions));
    }

    /// The parameters and buffers of bounce_photon. `hits`: those of the paths on meshes.
    template <backend B>
    kernels::bounce_photon::Params params_of_bounce(const path_batch<B>& batch, const render_settings& settings)
    {
        return {.paths = batch.paths,
            .first_path = batch.first,
            .last_frame = settings.map.photon_depth,
            .seed = settings.seed,
            .ends = batch.ends};
    }
    template <backend B>
    auto reads_of_bounce(const device_scene<B>& s, const photon_frames<B>& f, const mesh_hits<B>& hits)
    {
        return reads(s.records, f.positions, f.powers, f.directions, f.next_origins, f.next_directions, hits.places,
            hits.normals, hits.shadings, hits.colors);
    }
    template <backend B>
    auto writes_of_bounce(photon_frames<B>& f)
    {
        return writes(f.positions, f.powers, f.directions, f.next_origins, f.next_directions);
    }

    /// trace_batch by a pass for each bounce.
    template <backend B>
    uint trace_batch_by_passes(B& device, const device_scene<B>& s, photon_frames<B>& f, const path_batch<B>& batch,
        const render_settings& settings)
    {
        const uint paths = batch.paths;
        mesh_hits<B> hits(device, s, paths);
        mesh_rays<B> rays(device, s.has_meshes() ? paths : 0);
        emit_photons(device, s, f, batch, settings.seed);
        uint frame = 1;
        for (; frame <= settings.map.photon_depth; ++frame) {
            if (s.has_meshes()) {
                device.template run<kernels::photon_to_search>(paths, {.first = (frame - 1) * paths},
                    reads(f.positions, f.next_origins, f.next_directions), writes(rays.origins, rays.directions));
                rays.find(device, s, hits);
            }
            device.template run<kernels::bounce_photon>({paths, frame * paths, s.layout.features},
                params_of_bounce(batch, settings), reads_of_bounce(s, f, hits), writes_of_bounce(f));
            if (frame % 4 == 0
                && checked_count<kernels::path_goes_on>(device, {paths, frame * paths}, {}, reads(f.positions)) == 0)
                return frame + 1;
        }
        return frame;
    }
} // namespace detail

/// Traces a batch of paths, and returns the number of frames. Every 4 bounces it counts the paths that are still
/// active, and stops if there are none.
template <backend B>
uint trace_batch(B& device, const device_scene<B>& s, detail::photon_frames<B>& f, const path_batch<B>& batch,
    const render_settings& settings)
{
    return detail::trace_batch_by_passes(device, s, f, batch, settings);
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
