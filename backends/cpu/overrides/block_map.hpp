// The cpu backend's override of block_map: the same order by radix sorts, photons into structures of arrays, and boxes
// by SIMD code.
#pragma once

#include <photongrid/backends/cpu/overrides/curve_order.hpp>
#include <photongrid/backends/cpu/overrides/sorted_map.hpp>
#include <photongrid/map/block_map.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace cpu {
    /// The box around the children of a node, as in parent_box.glsl.
    inline void find_parent_box(const soa_vectors<float>& corners, uint nodes, uint node)
    {
        const uint child = kernels::first_child(node), low = kernels::low_corner(node),
                   high = kernels::high_corner(node);
        for (float* const to : {corners.x, corners.y, corners.z}) {
            to[low] = 3e38f;
            to[high] = -3e38f;
            if (child < nodes) {
                const float *const lows = to + kernels::low_corner(child),
                                   *const highs = to + kernels::high_corner(child);
                to[low] = std::min(to[low], *std::min_element(lows, lows + kernels::BLOCK));
                to[high] = std::max(to[high], *std::max_element(highs, highs + kernels::BLOCK));
            }
        }
        corners.w[low] = corners.w[high] = 0;
    }
} // namespace cpu

/// The same map as the generic block_map.
#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    map_buffers<cpu_backend>
    block_map(cpu_backend& device, photons<cpu_backend> p, uint parts)
{
    const cpu_backend::stopwatch watch;
    const uint n = p.size();
    map_buffers<cpu_backend> map;
    cpu::curve_job j{
        .positions = device.elements(p.positions).data(), .powers = device.elements(p.powers).data(), .parts = parts};
    auto [pairs, seen] = cpu::begin_order(device, j, n);
    map.invalid = seen.invalid;
    map.left_out = parts != every_part ? seen.left_out : 0;
    map.in_blocks = seen.ordered;
    map.curve = detail::curve_through(glm::vec4(seen.low, 0), glm::vec4(seen.high, 0));
    map.words = detail::words_needed(detail::sample_positions(device, p, detail::curve_sample), map.curve, n);
    j.curve = map.curve;
    j.words = map.words;
    map.list = cpu::order_along_curve(device, j, std::move(pairs), 2);
    for (auto* attribute : {&p.positions, &p.powers, &p.directions, &p.normals})
        if (attribute->size() != 0)
            *attribute = cpu::in_order_of(device, device.elements(map.list), *attribute);
    map.photons = std::move(p);

    map.levels = detail::tree_levels(map.in_blocks);
    const uint nodes = detail::tree_nodes(map.in_blocks);
    uint level = map.levels - 1, first = kernels::first_of_level(level);
    map.boxes = device.make<glm::vec4>(std::size_t{2} * nodes);
    const auto photons = device.components(map.photons.positions);
    const auto corners = device.components_to_write(map.boxes);
    device.threads().for_blocks(nodes - first, 1024, [&](std::size_t begin, std::size_t past) {
        cpu::find_boxes(photons, map.in_blocks, begin, past, first, corners);
    });
    while (level > 0) {
        const uint past = first;
        first = kernels::first_of_level(--level);
        for (uint node = first; node < past; ++node)
            cpu::find_parent_box(corners, nodes, node);
    }
    device.count_passes("block_map", 1, watch);
    return map;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
