// The cpu backend's photon tracing: each path is traced to its end by one thread, so that paths that ended cost
// nothing.
#pragma once

#include <photongrid/backends/cpu/cpu_backend.hpp>
#include <photongrid/trace/bounce_photon.kernel.hpp>
#include <photongrid/trace/photon_frames.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Computes the same frames as the generic trace_batch, up to the end of each path.
template <backend B>
requires std::same_as<B, cpu_backend> uint trace_batch(B& device, const device_scene<B>& s, detail::photon_frames<B>& f,
    const path_batch<B>& batch, const render_settings& settings)
{
    const uint paths = batch.paths;
    if (s.has_meshes()) // searches for hits on meshes come between bounces
        return detail::trace_batch_by_passes(device, s, f, batch, settings);
    const detail::mesh_hits<B> none(device, s, 0);
    detail::emit_photons(device, s, f, batch, settings.seed);
    const uint longest = device.template run_frames<kernels::bounce_photon>({paths, paths, s.layout.features}, paths,
        detail::params_of_bounce(batch, settings), detail::reads_of_bounce(s, f, none), detail::writes_of_bounce(f),
        settings.map.photon_depth);
    return longest + 1;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
