// The Vulkan backend's photon tracing: a bounce processes only the paths that continue.
#pragma once

#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/trace/bounce_photon.kernel.hpp>
#include <photongrid/trace/photon_event.kernel.hpp>
#include <photongrid/trace/photon_frames.hpp>

namespace photongrid {

/// Computes the same frames as the generic trace_batch, except that the powers and directions of paths that ended
/// earlier are not written.
template <backend B>
requires std::same_as<B, vulkan_backend> uint trace_batch(B& device, const device_scene<B>& s,
    detail::photon_frames<B>& f, const path_batch<B>& batch, const render_settings& settings)
{
    const uint paths = batch.paths;
    if (s.has_meshes()) // other passes come between bounces
        return detail::trace_batch_by_passes(device, s, f, batch, settings);
    const detail::mesh_hits<B> none(device, s, 0);
    detail::emit_photons(device, s, f, batch, settings.seed);
    constexpr uint together = 8;
    uint frame = 1;
    for (bool finished = false; !finished && frame <= settings.map.photon_depth;) {
        const uint passes = std::min(together, settings.map.photon_depth + 1 - frame);
        // A record with this value in every word means that the path has ended before.
        const auto ended = std::bit_cast<uint>(
            kernels::event_code(kernels::NO_SURFACE, kernels::ENDED_BEFORE, kernels::NOTHING_BEFORE));
        device.fill(f.positions, std::size_t{frame} * paths, std::size_t{passes} * paths, ended);
        const auto p = device.template run_frames<kernels::bounce_photon>({paths, frame * paths, s.layout.features},
            paths, detail::params_of_bounce(batch, settings), detail::reads_of_bounce(s, f, none),
            detail::writes_of_bounce(f), passes);
        frame += p.passes;
        finished = p.finished;
    }
    return frame;
}

} // namespace photongrid
