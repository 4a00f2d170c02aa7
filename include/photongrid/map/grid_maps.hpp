// The two ways to build a grid map: sorting and stencil routing (section 2.2).
#pragma once

#include <photongrid/map/bitonic_sort.hpp>
#include <photongrid/map/gather_vector.kernel.hpp>
#include <photongrid/map/grid_index.hpp>
#include <photongrid/map/invalid_photon.kernel.hpp>
#include <photongrid/map/map_buffers.hpp>
#include <photongrid/map/other_part.kernel.hpp>
#include <photongrid/map/packed_cell.kernel.hpp>
#include <photongrid/map/packed_photon.kernel.hpp>
#include <photongrid/map/pair_value.kernel.hpp>
#include <photongrid/map/photon_cell.kernel.hpp>
#include <photongrid/map/prefix_sums.hpp>
#include <photongrid/map/range_past_end.kernel.hpp>
#include <photongrid/map/share_power.kernel.hpp>
#include <photongrid/map/stencil_route.hpp>
#include <photongrid/map/surplus_kind.hpp>

#include <bit>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace detail {
    /// Takes the photons of `list` in its order, one attribute at a time, so that only one attribute is in memory
    /// twice.
    template <backend B>
    void reorder(B& device, photons<B>& p, const buffer_of<B, uint>& list)
    {
        const uint n = p.size(), taken_photons = static_cast<uint>(list.size());
        for (auto* attribute : {&p.positions, &p.powers, &p.directions, &p.normals}) {
            if (attribute->size() == 0)
                continue;
            auto taken = device.template make<glm::vec4>(taken_photons);
            device.template run<kernels::gather_vector>(
                taken_photons, {.photons = n}, reads(list, *attribute), writes(taken));
            *attribute = std::move(taken);
        }
    }

    /// Ends the building of a map: moves the photons into it in the order of its list, and counts those of other parts
    /// of the light.
    template <backend B>
    void take_photons(B& device, map_buffers<B>& map, photons<B> p, uint parts)
    {
#ifdef PHOTONGRID_GUARD_READS // searches would visit up to 2^32 photons that are not there
        if (const auto wrong
            = checked_count<kernels::range_past_end>(device, map.cells.size(), {.photons = p.size()}, reads(map.cells));
            wrong > 0)
            throw backend_error(device.caps().backend + ": " + std::to_string(wrong) + " cell ranges end past the "
                + std::to_string(p.size()) + " photons; the device computed them wrongly");
#endif
        if (parts != every_part)
            map.left_out = checked_count<kernels::other_part>(device, p.size(), {.parts = parts}, reads(p.positions));
        reorder(device, p, map.list);
        map.photons = std::move(p);
    }
} // namespace detail

/// Builds a photon map by sorting (2.2.1): exact, in L(L+1)/2 + 5 passes and one per attribute, with L = ceil(log2 n).
/// It consumes the photons. Photons of other parts of the light than `parts` are in no cell.
/// \throws backend_error if the device has no room.
/// \snippet snippets.cpp sorted_map
template <backend B>
map_buffers<B> sorted_map(B& device, photons<B> p, const grid& g, uint parts = every_part)
{
    const uint n = p.size();
    map_buffers<B> map;
    map.cells_of = g;
    map.invalid = detail::checked_count<kernels::invalid_photon>(device, n, {}, reads(p.positions, p.powers));
    {
        // The pairs include the sort's padding, so that it need not copy them.
        auto pairs = device.template make<glm::uvec2>(n == 0 ? 0 : std::bit_ceil(n));
        device.template run<kernels::photon_cell>(
            pairs.size(), {.grid = g, .photons = n, .parts = parts}, reads(p.positions, p.powers), writes(pairs));
        bitonic_sort(device, pairs);
        map.cells = grid_index(device, pairs, cell_count(g));
        map.list = device.template make<uint>(n);
        device.template run<kernels::pair_value>(n, {}, reads(pairs), writes(map.list));
    }
    detail::take_photons(device, map, std::move(p), parts);
    return map;
}

/// How a map is routed: stencil_route() with m x m slots per cell. `surplus` says what becomes of photons for which a
/// cell has no slot.
struct routing {
    uint m;
    uint seed = 0; ///< of the order in which photons are drawn
    uint parts = every_part;
    surplus_kind surplus = surplus_kind::photons;

    routing(uint m_, uint seed_ = 0, uint parts_ = every_part, surplus_kind surplus_ = surplus_kind::photons)
        : m(m_), seed(seed_), parts(parts_), surplus(surplus_)
    {
    }
};

/// Builds a photon map by stencil routing (2.2.2): few passes, but approximate where cells overflow. The gaps that
/// routing leaves between cells are removed. It consumes the photons.
/// \throws std::invalid_argument for m outside 1 to 16 or more than 2^27 photons; backend_error if cells x slots exceed
///         the device's limit.
/// \snippet snippets.cpp routed_map
template <backend B>
map_buffers<B> routed_map(B& device, photons<B> p, const grid& g, const routing& by)
{
    const uint n = p.size();
    const uint cells = cell_count(g);
    map_buffers<B> map;
    map.cells_of = g;
    map.invalid = detail::checked_count<kernels::invalid_photon>(device, n, {}, reads(p.positions, p.powers));
    buffer_of<B, uint> entries; // of each entry's photon
    {
        auto routed = stencil_route(device, p, g, by.m, by.seed, by.parts);
        map.surpluses = std::move(routed.surpluses);
        map.overflowing_cells = static_cast<uint>(routed.overflowing_cells);
        p.powers = std::move(routed.powers);
        if (by.surplus == surplus_kind::power) // a cell has as many entries as photons that it keeps
            device.template run<kernels::pair_value>(cells, {}, reads(routed.cells), writes(routed.arrived));
        const auto sums = prefix_sums(device, routed.arrived);
        map.cells = device.template make<glm::uvec2>(cells);
        device.template run<kernels::packed_cell>(cells, {}, reads(sums, routed.arrived), writes(map.cells));
        map.list = device.template make<uint>(n);
        entries = device.template make<uint>(n);
        device.template run<kernels::packed_photon>(
            n, {.cells = cells}, reads(sums, routed.cells, routed.list), writes(map.list, entries));
    }
    detail::take_photons(device, map, std::move(p), by.parts);
    device.template run<kernels::share_power>(n, {}, reads(entries), writes(map.photons.powers));
    return map;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
