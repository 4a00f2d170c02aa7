// The two ways to a photon map, composed of the algorithms (section 2.2).
#pragma once

#include <photongrid/bitonic_sort.hpp>
#include <photongrid/grid_index.hpp>
#include <photongrid/photon_map.hpp>
#include <photongrid/stencil_route.hpp>

#include <bit>

namespace photongrid {

/// A photon map by sorting (2.2.1): exact, compact, L(L+1)/2 + 3 passes. Takes the photons over.
template <backend B>
photon_map<B> sorted_map(B& b, photons<B> p, const grid& g)
{
    const uint n = p.size();
    photon_map<B> map;
    map.cells_of = g;
    // The pairs are made with their padding, so that the sort need not copy them.
    auto pairs = b.template make<glm::uvec2>(n == 0 ? 0 : std::bit_ceil(n));
    b.template run<kernels::photon_cell>(pairs.size(), {.grid = g, .photons = n}, reads(p.positions, p.powers), writes(pairs));
    bitonic_sort(b, pairs);
    map.cells = grid_index(b, pairs, cell_count(g));
    map.list = b.template make<uint>(n);
    b.template run<kernels::pair_value>(n, {}, reads(pairs), writes(map.list));
    map.invalid = detail::checked_count<kernels::invalid_photon>(b, n, {}, reads(p.positions, p.powers));
    map.photons = std::move(p);
    return map;
}

/// A photon map by stencil routing with m x m slots a cell (2.2.2): approximate where cells overflow, few passes.
/// Takes the photons over. `seed` orders the drawing.
template <backend B>
photon_map<B> routed_map(B& b, photons<B> p, const grid& g, uint m, uint seed = 0)
{
    photon_map<B> map;
    map.cells_of = g;
    map.contiguous = false;
    auto routed = stencil_route(b, p, g, m, seed);
    map.invalid = detail::checked_count<kernels::invalid_photon>(b, p.size(), {}, reads(p.positions, p.powers));
    map.cells = std::move(routed.cells);
    map.list = std::move(routed.list);
    map.surpluses = std::move(routed.surpluses);
    map.overfull_cells = static_cast<uint>(routed.overfull_cells);
    p.powers = std::move(routed.powers);
    map.photons = std::move(p);
    return map;
}

} // namespace photongrid
