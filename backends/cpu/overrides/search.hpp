// Code that the cpu backend's estimates and lists share: the order of the query points, and the job for the SIMD code.
#pragma once

#include <photongrid/backends/cpu/cpu_backend.hpp>
#include <photongrid/backends/cpu/overrides/curve_order.hpp>
#include <photongrid/backends/cpu/overrides/radix_sort.hpp>
#include <photongrid/backends/cpu/overrides/simd.hpp>
#include <photongrid/estimate/knn_settings.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::cpu {

/// The number of consecutive points that one thread processes. Blocks do not depend on the number of threads, because
/// the queries of a block share work.
inline constexpr std::size_t search_block_size = 256;

/// The order of the points along a Morton curve (Morton 1966), which keeps neighbours together. The curve has 1,024
/// steps along each axis of the grid.
inline buffer<uint> order_along_curve(cpu_backend& device, const grid& g, const buffer<glm::vec4>& points_of)
{
    const std::size_t n = points_of.size();
    auto pairs = device.make<glm::uvec2>(n);
    auto scratch = device.make<glm::uvec2>(n);
    const auto points = device.elements(points_of);
    const auto to = device.elements_to_write(pairs);
    const glm::vec3 steps = 1024.0f / (glm::vec3(g.cell) * glm::vec3(g.resolution));
    const auto spread = [](float u) {
        u = u > 0.0f ? u : 0.0f;
        auto v = static_cast<uint>(u < 1023.0f ? u : 1023.0f);
        v = (v | v << 16) & 0x030000FFu;
        v = (v | v << 8) & 0x0300F00Fu;
        v = (v | v << 4) & 0x030C30C3u;
        return (v | v << 2) & 0x09249249u;
    };
    device.threads().for_blocks(n, 4096, [&](std::size_t first, std::size_t past) {
        for (std::size_t i = first; i < past; ++i) {
            const glm::vec3 u = (glm::vec3(points[i]) - glm::vec3(g.origin)) * steps;
            to[i] = {spread(u.x) | spread(u.y) << 1 | spread(u.z) << 2, static_cast<uint>(i)};
        }
    });
    const auto sorted = radix_sort(device.threads(), to.data(), device.elements_to_write(scratch).data(), n);
    return values_of(device, device.elements(sorted.in_scratch ? scratch : pairs));
}

/// The order of the points of a search, which keeps neighbours together: along the curve of a block map, else along a
/// Morton curve.
inline buffer<uint> order_for_search(
    cpu_backend& device, const map_buffers<cpu_backend>& map, const buffer<glm::vec4>& points)
{
    if (!map.has_blocks())
        return order_along_curve(device, map.cells_of, points);
    const curve_job j{.curve = map.curve, .words = map.words, .positions = device.elements(points).data()};
    auto pairs = begin_order(device, j, points.size()).pairs;
    constexpr std::size_t least = 8; // fewer points at almost the same place need no order
    return order_along_curve(device, j, std::move(pairs), least);
}

/// The job of the search `in`, without the buffers for its results.
inline search_job make_search_job(const detail::search_inputs<cpu_backend>& in, const buffer<uint>& order)
{
    auto& device = *in.device;
    const auto& s = in.s;
    const auto& photons = in.map->photons;
    search_job j;
    j.cells_of = in.map->cells_of;
    j.cells = device.elements(in.map->cells);
    j.levels = in.map->levels;
    j.in_blocks = in.map->in_blocks;
    if (in.map->has_blocks())
        j.boxes = device.components(in.map->boxes);
    j.positions = device.components(photons.positions);
    j.powers = device.components(photons.powers);
    j.side = s.leaks.side;
    j.needs_photon_normals = s.leaks.needs_photon_normals();
    j.min_cosine = s.leaks.min_cosine;
    j.flattening = s.leaks.flattening > 1 ? s.leaks.flattening * s.leaks.flattening - 1.0f : 0.0f;
    j.half_spaces = s.half_spaces;
    if (j.side)
        j.directions = device.components(photons.directions);
    if (j.needs_photon_normals)
        j.normals = device.components(photons.normals);
    j.list = device.elements(in.map->list).data();
    j.points = device.elements(*in.points).data();
    j.in_plane = s.biases && in.normals != nullptr;
    j.bias_factor = detail::bias_factor(s.filter);
    if (s.leaks.needs_point_normals() || j.in_plane || j.half_spaces)
        j.point_normals = device.elements(*in.normals).data();
    j.order = device.elements(order).data();
    j.search = s.search;
    j.searching = in.searching();
    j.k = s.k;
    j.radii_at_points = s.radii_at_points;
    j.max_radius2 = in.max_radius2();
    j.min_radius2 = in.min_radius2();
    j.filter = s.filter;
    j.norm = detail::entry_of(s.filter).norm;
    j.leave_out = s.bias == bias_kind::unbiased;
    j.errors = s.errors;
    j.repeats = in.map->may_repeat();
    return j;
}

} // namespace photongrid::cpu

#include <photongrid/core/exact_end.hpp>
