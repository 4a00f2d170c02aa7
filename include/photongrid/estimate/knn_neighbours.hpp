// Lists of the k nearest photons of each point: ids and squared distances. A kernel of your own can then compute any
// sum over the neighbours (docs/guide/own_kernels.md).
//
//     knn_radius -> list_neighbours -> neighbour_pair -> sort_neighbours -> neighbour
#pragma once

#include <photongrid/estimate/knn_radius.hpp>
#include <photongrid/estimate/list_neighbours.kernel.hpp>
#include <photongrid/estimate/neighbour.kernel.hpp>
#include <photongrid/estimate/neighbour_pair.kernel.hpp>
#include <photongrid/estimate/neighbours_start.kernel.hpp>
#include <photongrid/estimate/sort_neighbours.kernel.hpp>

#include <bit>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The nearest photons of each point, nearest first; equal distances are ordered by id.
template <backend B>
struct neighbour_lists {
    uint k = 0;             ///< entries per list
    buffer_of<B, uint> ids; ///< point p's are entries p * k to p * k + k - 1: indices into the photons that the map
                            ///< was made from; `no_id`: no more neighbours
    buffer_of<B, float> distances2; ///< m^2, of the same photons; infinity where there is no neighbour
};

namespace detail {
    /// Throws if lists of this length are not possible.
    inline void check_lists(const knn_settings& s, std::size_t points, std::uint64_t most)
    {
        if (s.search != search_kind::exact_k)
            throw std::invalid_argument(
                "knn_neighbours: search: lists hold the k nearest photons; only search_kind::exact_k gives them");
        if (std::bit_ceil(std::uint64_t{s.k}) * std::max<std::uint64_t>(points, 1) > most)
            throw std::invalid_argument("knn_neighbours: k: " + std::to_string(s.k) + " neighbours of "
                + std::to_string(points) + " points are more than the " + std::to_string(most)
                + " entries that this device holds; ask for fewer points at a time");
    }

    /// The SWITCHes of kernel K, which writes pairs: neighbours that a list holds, or empty ones.
    template <class K, backend B>
    uint pair_switches(const search_inputs<B>& in, bool held)
    {
        return in.template policies<K>() | (held ? K::HELD_switch : 0u);
    }

    template <backend B>
    neighbour_lists<B> list_neighbours(const search_inputs<B>& in)
    {
        B& device = *in.device;
        const auto& m = *in.map;
        const uint n = static_cast<uint>(in.points->size()), k = in.s.k, padded = std::bit_ceil(k);
        neighbour_lists<B> lists{
            k, device.template make<uint>(std::size_t{n} * k), device.template make<float>(std::size_t{n} * k)};
        if (n == 0)
            return lists;
        auto pairs = device.template make<glm::uvec2>(std::size_t{n} * padded);
        const auto put = [&](uint entry, uint entries, bool held, const auto& indices, const auto& tally) {
            device.template run<kernels::neighbour_pair>(
                {std::size_t{n} * entries, entry * n, pair_switches<kernels::neighbour_pair>(in, held)},
                {.leaks = in.leaks(), .points = n},
                reads(*in.points, in.point_normals(), m.photons.positions, in.directions(), in.photon_normals(), m.list,
                    indices, tally),
                writes(pairs));
        };
        {
            knn_radius<B> radius_search(in);
            radius_search.advance();
            constexpr uint part = 16; // entries found at a time
            buffer_of<B, glm::uvec4> indices[] = {in.template make<glm::uvec4>(), in.template make<glm::uvec4>(),
                in.template make<glm::uvec4>(), in.template make<glm::uvec4>()};
            auto cursor = in.template make<glm::uvec4>(), tally = in.template make<glm::uvec4>();
            for (uint first = 0; first < k; first += part) {
                device.template run<kernels::neighbours_start>({n, 0u, first > 0 ? 1u : 0u},
                    {.searching = in.searching() ? 1u : 0u}, reads(*in.points, radius_search.chosen),
                    writes(cursor, tally));
                device.template run_until_done<kernels::list_neighbours>(
                    {n, 0u,
                        in.template map_switches<kernels::list_neighbours>()
                            | in.template repeats<kernels::list_neighbours>()},
                    {.grid = m.cells_of,
                        .leaks = in.leaks(),
                        .visits = in.s.visits_per_pass,
                        .ranges = in.s.ranges_per_pass,
                        .levels = m.levels,
                        .in_blocks = m.in_blocks},
                    reads(*in.points, in.point_normals(), m.cells, m.photons.positions, in.directions(),
                        in.photon_normals(), m.list, radius_search.radius, m.boxes),
                    writes(indices[0], indices[1], indices[2], indices[3], cursor, tally), all_passes);
                for (uint four = 0; four < part && first + four < padded; four += 4)
                    put(first + four, std::min(4u, padded - (first + four)), true, indices[four / 4], tally);
            }
            const uint filled = std::min((k + part - 1) / part * part, padded);
            if (filled < padded)
                put(filled, padded - filled, false, indices[0], tally);
        }
        if (padded > 1) {
            auto next = device.template make<glm::uvec2>(pairs.size());
            for (uint run = 2; run <= padded; run *= 2)
                for (uint stride = run / 2; stride > 0; stride /= 2) {
                    device.template run<kernels::sort_neighbours>(
                        pairs.size(), {.points = n, .run = run, .stride = stride}, reads(pairs), writes(next));
                    std::swap(pairs, next);
                }
        }
        device.template run<kernels::neighbour>(
            lists.ids.size(), {.points = n, .k = k}, reads(pairs), writes(lists.ids, lists.distances2));
        return lists;
    }
} // namespace detail

/// The k nearest photons of each point within settings.max_radius, by exact search on the device. `points`: xyz, m; a
/// point that is not finite, or whose w is not above 0, has an empty list. The settings' filter, bias and errors are
/// ignored. It needs 24 bytes per entry while it runs, with k rounded up to a power of two.
/// \throws std::invalid_argument for k = 0, a radius that is NaN, another search than exact_k, leak policies
/// without normals, or more entries than the device holds in one buffer.
/// \snippet snippets.cpp knn_neighbours
template <backend B>
neighbour_lists<B> knn_neighbours(
    B& device, const map_buffers<B>& map, const buffer_of<B, glm::vec4>& points, const knn_settings& settings)
{
    detail::check_lists(settings, points.size(), device.caps().max_elements);
    return detail::list_neighbours(detail::search_inputs<B>(device, map, points, nullptr, settings));
}
/// With the unit normals of the surfaces that the points lie on, for leak policies.
template <backend B>
neighbour_lists<B> knn_neighbours(B& device, const map_buffers<B>& map, const buffer_of<B, glm::vec4>& points,
    const buffer_of<B, glm::vec4>& normals, const knn_settings& settings)
{
    detail::check_lists(settings, points.size(), device.caps().max_elements);
    return detail::list_neighbours(detail::search_inputs<B>(device, map, points, &normals, settings));
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
