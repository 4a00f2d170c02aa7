// The cpu backend's search for the hits of rays, in SIMD code.
#pragma once

#include <photongrid/backends/cpu/cpu_backend.hpp>
#include <photongrid/backends/cpu/overrides/in_order.hpp>
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
    // With the usual steps a pass, 65,536 rays: work for many threads, and well below a second of one.
    const std::size_t n = states_.size(), per_pass = std::size_t{64} * settings_.steps_per_pass,
                      begin = std::min(n, passes_ * per_pass);
    auto part = cpu::next_passes(n, begin, per_pass, passes);
    if (part.end > begin) {
        cpu::ray_job j;
        j.nodes = device.elements(triangles_->nodes).data();
        j.blocks = device.elements(triangles_->blocks).data();
        j.low = triangles_->low;
        j.high = triangles_->high;
        j.any = settings_.kind == hit_kind::any;
        j.origins = device.elements(*origins_).data();
        j.directions = device.elements(*directions_).data();
        j.states = device.elements_to_write(states_).data();
        device.threads().for_blocks(part.end - begin, 256,
            [&](std::size_t first, std::size_t past) { cpu::trace_block(j, begin + first, begin + past); });
    }
    passes_ += part.made.passes;
    finished_ = part.made.finished;
    device.count_passes("ray_search", part.made.passes, watch);
    return part.made;
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
