// The cpu backend's search for the hits of rays, in SIMD code.
#pragma once

#include <photongrid/backends/cpu/cpu_backend.hpp>
#include <photongrid/backends/cpu/overrides/simd.hpp>
#include <photongrid/backends/cpu/overrides/wide_tree.hpp>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    triangle_tree
    build_triangle_tree(cpu_backend& device, const mesh& m)
{
    return detail::build_triangle_tree(m, [&](std::size_t n, const auto& f) {
        device.threads().for_blocks(n, 1, [&](std::size_t first, std::size_t past) {
            for (std::size_t i = first; i < past; ++i)
                f(i);
        });
    });
}

#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    device_triangles<cpu_backend>
    upload_triangles(cpu_backend& device, const triangle_tree& tree)
{
    const auto w = cpu::tree_widener(tree).build();
    return {
        device.upload(std::span<const float>(w.nodes)), device.upload(std::span<const float>(w.blocks)), w.low, w.high};
}

template <>
#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    progress
    ray_search<cpu_backend>::advance(uint passes)
{
    auto& device = *device_;
    const cpu_backend::stopwatch watch;
    const std::size_t n = states_.size(), rays_per_pass = std::size_t{64} * settings_.steps_per_pass;
    const std::size_t begin = std::min(n, passes_ * rays_per_pass),
                      left = (n - begin + rays_per_pass - 1) / rays_per_pass;
    const auto now = static_cast<uint>(std::min<std::size_t>(passes, left));
    const std::size_t end = std::min(n, begin + now * rays_per_pass);
    if (end > begin) {
        cpu::ray_job j;
        j.nodes = device.elements(triangles_->nodes).data();
        j.blocks = device.elements(triangles_->blocks).data();
        j.low = triangles_->low;
        j.high = triangles_->high;
        j.any = settings_.kind == hit_kind::any;
        j.origins = device.elements(*origins_).data();
        j.directions = device.elements(*directions_).data();
        j.states = device.elements_to_write(states_).data() + begin;
        j.origins += begin;
        j.directions += begin;
        device.threads().for_blocks(
            end - begin, 256, [&](std::size_t first, std::size_t past) { cpu::trace_block(j, first, past); });
    }
    passes_ += now;
    device.count_passes("ray_search", now, watch);
    progress p;
    p.passes = now;
    for (uint i = 0; i < now; ++i)
        p.active.push_back(n - begin - i * rays_per_pass);
    p.finished = finished_ = end == n;
    return p;
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
