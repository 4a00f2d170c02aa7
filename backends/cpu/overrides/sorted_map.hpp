// The cpu backend's override of sorted_map: photons are sorted into ranges of cells and then by cell, into structures
// of arrays, which the search needs (map_simd.hpp).
#pragma once

#include <photongrid/backends/cpu/overrides/bitonic_sort.hpp>
#include <photongrid/backends/cpu/overrides/grid_index.hpp>
#include <photongrid/backends/cpu/overrides/simd.hpp>
#include <photongrid/map/map_builders.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace cpu {
    /// An attribute in the order of the list.
    inline cpu_backend::buffer<glm::vec4> in_order_of(
        cpu_backend& device, std::span<const uint> list, const cpu_backend::buffer<glm::vec4>& attribute)
    {
        const std::size_t n = list.size();
        const auto from = device.elements(attribute);
        auto taken = device.make<glm::vec4>(n);
        const auto to = device.components_to_write(taken);
        device.threads().for_blocks(n, 4096, [&](std::size_t first, std::size_t past) {
            constexpr std::size_t ahead = 16; // prefetch so far ahead, since reads have random addresses
            for (std::size_t i = first; i < past; ++i) {
                if (i + ahead < n)
                    __builtin_prefetch(&from[list[i + ahead]]);
                const glm::vec4& v = from[list[i]];
                to.x[i] = v.x;
                to.y[i] = v.y;
                to.z[i] = v.z;
                to.w[i] = v.w;
            }
        });
        return taken;
    }
} // namespace cpu

/// The same map as the generic sorted_map, which it uses for 2^27 cells and more. It needs 44 bytes per photon while it
/// runs.
#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    map_buffers<cpu_backend>
    sorted_map(cpu_backend& device, photons<cpu_backend> p, const grid& g, uint parts)
{
    const uint n = p.size();
    cpu::map_job j;
    j.cells_of = g;
    j.cells = cell_count(g);
    j.parts = parts;
    j.large = n > 131072;
    // A bucket has about 1,000 photons or more, and at most 2^most_shift cells, so that their counters fit a cache.
    const uint buckets = std::clamp(n / 1024u, 1u, cpu::map_job::most_buckets);
    while (j.shift < cpu::map_job::most_shift && j.buckets() > buckets)
        ++j.shift;
    if (j.buckets() > cpu::map_job::most_buckets)
        return sorted_map<cpu_backend>(device, std::move(p), g, parts);

    const cpu_backend::stopwatch watch;
    map_buffers<cpu_backend> map;
    map.cells_of = g;
    map.cells = device.make<glm::uvec2>(j.cells);
    map.list = device.make<uint>(n);
    auto positions = device.make<glm::vec4>(n), powers = device.make<glm::vec4>(n);
    {
        // One range per thread, so that counters are not shared. The result does not depend on the number of ranges.
        const std::size_t threads = n < 16384 ? 1 : device.threads().threads(),
                          part = std::max<std::size_t>((n + threads - 1) / threads, 1);
        std::vector<std::array<uint, cpu::map_job::most_buckets>> next(threads);
        auto keys = device.make<uint>(n);
        auto records = device.make<glm::vec4>(std::size_t{2} * n);
        auto pairs = device.make<glm::uvec2>(n);
        j.positions = device.elements(p.positions).data();
        j.powers = device.elements(p.powers).data();
        j.keys = device.elements_to_write(keys).data();
        j.records = reinterpret_cast<cpu::photon_record*>(device.elements_to_write(records).data());
        j.pairs = device.elements_to_write(pairs).data();
        j.index = device.elements_to_write(map.cells).data();
        j.list = device.elements_to_write(map.list).data();
        j.out_positions = device.components_to_write(positions);
        j.out_powers = device.components_to_write(powers);

        std::atomic<uint> invalid = 0, left_out = 0;
        device.threads().for_blocks(n, part, [&](std::size_t first, std::size_t past) {
            uint bad = 0, other = 0;
            next[first / part].fill(0);
            cpu::find_cells(j, first, past, next[first / part].data(), bad, other);
            invalid += bad;
            left_out += other;
        });
        map.invalid = invalid;
        map.left_out = parts != every_part ? left_out.load() : 0u;

        std::vector<uint> begin(std::size_t{j.buckets()} + 1);
        uint sum = 0;
        for (uint v = 0; v < j.buckets(); ++v) {
            begin[v] = sum;
            for (auto& of_part : next)
                sum += std::exchange(of_part[v], sum);
        }
        begin[j.buckets()] = sum;
        device.threads().for_blocks(n, part, [&](std::size_t first, std::size_t past) {
            const auto lines = std::make_unique_for_overwrite<cpu::scatter_lines>();
            cpu::scatter_photons(j, first, past, next[first / part].data(), *lines);
        });
        device.threads().for_blocks(j.buckets(), std::max(1u, j.buckets() / (8 * device.threads().threads())),
            [&](std::size_t first, std::size_t past) {
                cpu::bucket_scratch scratch;
                for (std::size_t v = first; v < past; ++v)
                    cpu::order_bucket(j, static_cast<uint>(v), begin[v], begin[v + 1], scratch);
            });
    }
    p.positions = std::move(positions);
    p.powers = std::move(powers);
    for (auto* attribute : {&p.directions, &p.normals})
        if (attribute->size() != 0)
            *attribute = cpu::in_order_of(device, device.elements(map.list), *attribute);
    map.photons = std::move(p);
    device.count_passes("sorted_map", 1, watch);
    return map;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
