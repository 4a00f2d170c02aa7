// Stencil routing (section 2.2.2, figure 5): one pass scatters every photon to a slot of its cell. Photons for which a
// cell has no slot give their power to the photons that it keeps.
#pragma once

#include <photongrid/map/map_buffers.hpp>
#include <photongrid/map/overflowing_cell.kernel.hpp>
#include <photongrid/map/redistribute_power.kernel.hpp>
#include <photongrid/map/route_photon.kernel.hpp>
#include <photongrid/map/routed_cell.kernel.hpp>

#include <photongrid/core/exact_begin.hpp>

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
    /// What a function that routes calls itself and its destinations in errors.
    struct routing_words {
        const char* caller;
        const char* destination; ///< "cell": one of them
        const char* advice;      ///< if the device has no room for all slots
    };
    inline constexpr routing_words stencil_route_words{
        "stencil_route", "cell", "Use a coarser grid or a smaller m, or build the map by sorting"};

    /// Throws if one of `sums` partial sums per cell could receive more photons than a float counts one by one.
    inline void check_route_count(uint photons, uint sums, const routing_words& words = stencil_route_words)
    {
        constexpr uint most = 1u << 24;
        if (route_block(photons, sums) > most)
            throw std::invalid_argument(std::string(words.caller) + ": photons: " + std::to_string(photons)
                + "; at most " + std::to_string(std::uint64_t{most} * sums) + " are counted exactly if one "
                + words.destination + " receives them all. Build the map by sorting");
    }
    inline void check_slots(uint m, const routing_words& words)
    {
        if (m < 1 || m > 16)
            throw std::invalid_argument(std::string(words.caller) + ": m: " + std::to_string(m)
                + "; it must be from 1 to 16, for m x m slots per " + words.destination);
    }
    /// Throws if the device cannot hold the slots and the sums of so many destinations.
    inline void check_room(
        const capabilities& caps, uint destinations, uint capacity, uint sums, const routing_words& words)
    {
        const std::uint64_t slots = std::uint64_t{destinations} * capacity;
        if (std::max(slots, std::uint64_t{destinations} * sums) > caps.max_elements || slots > 0xFFFFFFFEu)
            throw backend_error(caps.backend + ": " + words.caller + ": " + std::to_string(destinations) + " "
                + words.destination + "s of " + std::to_string(capacity) + " slots are " + std::to_string(slots)
                + " slots; this device holds " + std::to_string(caps.max_elements) + ". " + words.advice);
    }

    /// Cells of m x m slots, with `sums` partial sums each. `conserves`: the SWITCH of routed_cell.
    struct routing_cells {
        uint cells;
        uint m;
        uint sums;
        bool conserves;
    };

    /// Routes the draws of kernel K, one per photon. The result has no powers yet: that of each kept photon is to be
    /// multiplied by its cell's `scales`, and its cell's surplus added.
    template <route_kernel K, backend B, class Reads>
    routed_cells<B> route_draws(B& device, const photons<B>& p, const typename K::Params& args, Reads inputs,
        const routing_cells& to, buffer_of<B, glm::vec4>& scales)
    {
        const auto [cells, m, sums, conserves] = to;
        const uint capacity = route_capacity(m);
        routed_cells<B> r;
        r.list = device.template make<uint>(std::size_t{cells} * capacity);
        auto partial_sums = device.template make<glm::vec4>(std::size_t{cells} * sums);
        device.template route<K>(p.size(), args, inputs, {cells, m}, r.list, partial_sums);
        r.cells = device.template make<glm::uvec2>(cells);
        r.surpluses = device.template make<glm::vec4>(cells);
        r.totals = device.template make<glm::vec4>(cells);
        r.arrived = device.template make<uint>(cells);
        scales = device.template make<glm::vec4>(cells);
        device.template run<kernels::routed_cell>({cells, 0, conserves ? 1u : 0u}, {.capacity = capacity, .sums = sums},
            reads(partial_sums, r.list, p.powers), writes(r.cells, scales, r.surpluses, r.totals, r.arrived));
        r.overflowing_cells
            = checked_count<kernels::overflowing_cell>(device, cells, {.capacity = capacity}, reads(r.totals));
        return r;
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
    detail::check_slots(m, detail::stencil_route_words);
    const uint cells = cell_count(g);
    const uint n = p.size();
    // With eight partial sums per cell, the power of 70,000 equal photons has an error below 1e-4 in single precision.
    constexpr uint sums = 8;
    detail::check_route_count(n, sums);
    detail::check_room(device.caps(), cells, route_capacity(m), sums, detail::stencil_route_words);
    buffer_of<B, glm::vec4> scales;
    auto r
        = detail::route_draws<kernels::route_photon>(device, p, {.grid = g, .photons = n, .seed = seed, .parts = parts},
            reads(p.positions, p.powers), {cells, m, sums, true}, scales);
    r.powers = device.template make<glm::vec4>(n);
    device.template run<kernels::redistribute_power>(
        n, {.grid = g}, reads(p.positions, p.powers, scales, r.surpluses), writes(r.powers));
    return r;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
