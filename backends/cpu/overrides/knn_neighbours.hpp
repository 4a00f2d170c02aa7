// The cpu backend's lists of neighbours, in SIMD code.
#pragma once

#include <photongrid/backends/cpu/overrides/search.hpp>
#include <photongrid/estimate/knn_neighbours.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace cpu {
    inline neighbour_lists<cpu_backend> list_neighbours(const detail::search_inputs<cpu_backend>& in)
    {
        auto& device = *in.device;
        const cpu_backend::stopwatch watch;
        const std::size_t n = in.points->size();
        neighbour_lists<cpu_backend> lists{in.s.k, device.make<uint>(n * in.s.k), device.make<float>(n * in.s.k)};
        const auto order = order_for_search(device, *in.map, *in.points);
        auto job = make_search_job(in, order);
        job.ids = device.elements_to_write(lists.ids).data();
        job.distances2 = device.elements_to_write(lists.distances2).data();
        device.threads().for_blocks(
            n, search_block_size, [&](std::size_t first, std::size_t past) { search_block(job, first, past); });
        device.count_passes("knn_neighbours", 1, watch);
        return lists;
    }
} // namespace cpu

#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    neighbour_lists<cpu_backend>
    knn_neighbours(cpu_backend& device, const map_buffers<cpu_backend>& map, const cpu::buffer<glm::vec4>& points,
        const knn_settings& settings)
{
    detail::check_lists(settings, points.size(), device.caps().max_elements);
    return cpu::list_neighbours(detail::search_inputs<cpu_backend>(device, map, points, nullptr, settings));
}
#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    neighbour_lists<cpu_backend>
    knn_neighbours(cpu_backend& device, const map_buffers<cpu_backend>& map, const cpu::buffer<glm::vec4>& points,
        const cpu::buffer<glm::vec4>& normals, const knn_settings& settings)
{
    detail::check_lists(settings, points.size(), device.caps().max_elements);
    return cpu::list_neighbours(detail::search_inputs<cpu_backend>(device, map, points, &normals, settings));
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
