// Stencil routing (section 2.2.2, figure 5): one pass scatters every photon to a slot of its cell. Photons for which a
// cell has no slot give their power to the photons that it keeps.
#pragma once

#include <photongrid/map/map_buffers.hpp>
#include <photongrid/map/overflowing_cell.kernel.hpp>
#include <photongrid/map/redistribute_power.kernel.hpp>
#include <photongrid/map/route_photon.kernel.hpp>
#include <photongrid/map/routed_cell.kernel.hpp>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// The result of stencil_route. With cap = min(m*m, 255), cell c has the slots c*cap to c*cap + cap - 1.
template <backend B>
struct routed_cells {
    buffer_of<B, uint> list;             ///< per slot: photon id; `no_id`: empty
    buffer_of<B, glm::uvec2> cells;      ///< x: first slot, y: photons kept
    buffer_of<B, glm::vec4> powers;      ///< per photon, W, after redistribution
    buffer_of<B, glm::vec4> totals;      ///< per cell: rgb: power destined for it, W; w: number of photons
    buffer_of<B, uint> arrived;          ///< per cell: number of photons destined for it
    buffer_of<B, glm::vec4> surpluses;   ///< per cell: rgb: power added to each kept photon, W; w: power moved, W
    std::uint64_t overflowing_cells = 0; ///< cells that received more photons than they have slots
};

namespace detail {
    /// Throws if one of `sums` partial sums per cell could receive more photons than a float counts one by one.
    inline void check_route_count(uint photons, uint sums)
    {
        constexpr uint most = 1u << 24;
        if (route_block(photons, sums) > most)
            throw std::invalid_argument("stencil_route: photons: " + std::to_string(photons) + "; at most "
                + std::to_string(std::uint64_t{most} * sums)
                + " are counted exactly if one cell receives them all. Build the map by sorting");
    }
} // namespace detail

/// Routes photons to m x m slots per cell, with m from 1 to 16. Each cell keeps its first min(m*m, 255) photons in draw
/// order, which is a permutation of the ids by `seed` and the same on every backend. The power of each cell is
/// conserved per channel. Photons of other parts of the light than `parts` are discarded. The paper's "m = 16, about
/// 40^3 cells" in 1024 x 1024 leaves room for 16 slots, m = 4 (docs/design/decisions.md).
/// \throws std::invalid_argument for m outside 1 to 16 or more than 2^27 photons; backend_error if cells x slots exceed
///         the device's limit.
/// \snippet snippets.cpp stencil_route
template <backend B>
routed_cells<B> stencil_route(
    B& device, const photons<B>& p, const grid& g, uint m, uint seed = 0, uint parts = every_part)
{
    if (m < 1 || m > 16)
        throw std::invalid_argument(
            "stencil_route: m: " + std::to_string(m) + "; it must be from 1 to 16, for m x m slots per cell");
    const uint capacity = route_capacity(m);
    const uint cells = cell_count(g);
    const uint n = p.size();
    // With eight partial sums per cell, the power of 70,000 equal photons has an error below 1e-4 in single precision.
    constexpr uint sums = 8;
    detail::check_route_count(n, sums);
    const std::uint64_t slots = std::uint64_t{cells} * capacity;
    if (std::max(slots, std::uint64_t{cells} * sums) > device.caps().max_elements || slots > 0xFFFFFFFEu)
        throw backend_error(device.caps().backend + ": stencil_route: " + std::to_string(cells) + " cells of "
            + std::to_string(capacity) + " slots are " + std::to_string(slots) + " slots; this device holds "
            + std::to_string(device.caps().max_elements)
            + ". Use a coarser grid or a smaller m, or build the map by sorting");
    routed_cells<B> r;
    r.list = device.template make<uint>(slots);
    auto partial_sums = device.template make<glm::vec4>(std::size_t{cells} * sums);
    device.template route<kernels::route_photon>(n, {.grid = g, .photons = n, .seed = seed, .parts = parts},
        reads(p.positions, p.powers), cells, m, r.list, partial_sums);
    r.cells = device.template make<glm::uvec2>(cells);
    r.surpluses = device.template make<glm::vec4>(cells);
    r.totals = device.template make<glm::vec4>(cells);
    r.arrived = device.template make<uint>(cells);
    auto scales = device.template make<glm::vec4>(cells);
    device.template run<kernels::routed_cell>(cells, {.capacity = capacity, .sums = sums},
        reads(partial_sums, r.list, p.powers), writes(r.cells, scales, r.surpluses, r.totals, r.arrived));
    r.powers = device.template make<glm::vec4>(n);
    device.template run<kernels::redistribute_power>(
        n, {.grid = g}, reads(p.positions, p.powers, scales, r.surpluses), writes(r.powers));
    r.overflowing_cells
        = detail::checked_count<kernels::overflowing_cell>(device, cells, {.capacity = capacity}, reads(r.totals));
    return r;
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
