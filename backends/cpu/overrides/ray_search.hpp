// The cpu backend's search for the hits of rays, in SIMD code.
#pragma once

#include <photongrid/backends/cpu/cpu_backend.hpp>
#include <photongrid/backends/cpu/overrides/in_order.hpp>
#include <photongrid/backends/cpu/overrides/simd.hpp>
#include <photongrid/backends/cpu/overrides/wide_tree.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace cpu {
    /// Calls f(i) for each i below n, on the device's threads.
    inline auto run_on_threads(cpu_backend& device)
    {
        return [&device](std::size_t n, const auto& f) {
            device.threads().for_blocks(n, 1, [&](std::size_t first, std::size_t past) {
                for (std::size_t i = first; i < past; ++i)
                    f(i);
            });
        };
    }
} // namespace cpu

#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    triangle_tree
    build_triangle_tree(cpu_backend& device, const mesh& m)
{
    return detail::build_triangle_tree(m, cpu::run_on_threads(device), {.whole = cpu::wide});
}

#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    triangle_tree
    build_instance_tree(cpu_backend& device, std::span<const mesh> surfaces, std::span<const placement> placements)
{
    return detail::instance_tree_builder(surfaces, placements, {.whole = cpu::wide}).build(cpu::run_on_threads(device));
}

#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    device_triangles<cpu_backend>
    upload_triangles(cpu_backend& device, const triangle_tree& tree)
{
    auto made = cpu::tree_widener(tree).build(device, cpu::run_on_threads(device));
    made.instances = detail::upload_some(device, tree.instances);
    return made;
}

namespace cpu {
    /// What searches of these triangles have in common.
    inline ray_job job_for(cpu_backend& device, const device_triangles<cpu_backend>& triangles, hit_kind kind)
    {
        ray_job j;
        j.nodes = device.elements(triangles.nodes).data();
        j.blocks = device.elements(triangles.blocks).data();
        j.planes = device.elements(triangles.planes).data();
        j.low = triangles.low;
        j.high = triangles.high;
        if (triangles.instance_count() > 0) {
            j.instances = device.elements(triangles.instances).data();
            j.roots = triangles.roots.data();
        }
        j.any = kind == hit_kind::any;
        return j;
    }
} // namespace cpu

#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    ray_hit
    trace_ray(cpu_backend& device, const device_triangles<cpu_backend>& triangles, const glm::vec4& origin,
        const glm::vec4& direction, hit_kind kind)
{
    glm::uvec4 state = kernels::ray_state(0, 0, origin.w, kernels::NO_TRIANGLE);
    if (kernels::is_in_range(glm::vec3(origin), origin.w, glm::vec3(direction))) {
        auto j = cpu::job_for(device, triangles, kind);
        j.origins = &origin;
        j.directions = &direction;
        j.states = &state;
        cpu::trace_block(j, 0, 1);
    }
    return {kernels::distance_of_hit(state), kernels::triangle_of(state)};
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
        auto j = cpu::job_for(device, *triangles_, settings_.kind);
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

#include <photongrid/core/exact_end.hpp>
