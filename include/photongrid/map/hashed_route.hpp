// Stencil routing into few buckets instead of the cells of a grid that is too fine to store: an answer to the paper's
// section 4.4, where hashing the cells makes "power redistribution ... non-trivial".
//
//     rank: cell_word -> bitonic_sort, for each word of a cell's number, the low one first
//           begins_cell -> prefix_sums -> ranked_bucket -> route_by_bucket -> routed_cell -> survivor_power
//     hash: hashed_bucket --------------------------------^
//
// The photons that survive are photons as any others, for block_map or fitted_map to make a map of. Every search and
// estimate then works on them without knowing of buckets (docs/design/decisions.md, "Hashing ends where routing ends").
#pragma once

#include <photongrid/map/begins_cell.kernel.hpp>
#include <photongrid/map/bitonic_sort.hpp>
#include <photongrid/map/cell_word.kernel.hpp>
#include <photongrid/map/counted_photon.kernel.hpp>
#include <photongrid/map/grid_maps.hpp>
#include <photongrid/map/hashed_bucket.kernel.hpp>
#include <photongrid/map/invalid_photon.kernel.hpp>
#include <photongrid/map/prefix_sums.hpp>
#include <photongrid/map/ranked_bucket.kernel.hpp>
#include <photongrid/map/reordered.kernel.hpp>
#include <photongrid/map/route_by_bucket.kernel.hpp>
#include <photongrid/map/stencil_route.hpp>
#include <photongrid/map/survivor_power.kernel.hpp>
#include <photongrid/map/virtual_grid.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// How hashed_route assigns a bucket to a cell, and thereby the power of photons without a slot.
enum class bucket_kind {
    /// The rank of the cell among those that hold photons: a perfect hash by two sorts of the photons, so no cells
    /// share a bucket. The kept photons of a cell receive the power of its others as in stencil_route: exactly, per
    /// channel.
    rank,
    /// A hash of the cell's coordinates: no sort, but cells may share a bucket. Each kept photon is weighted N/K, of N
    /// that came to its bucket and K kept. The power of each cell is right in the mean over seeds, not for each seed.
    hash,
};

/// Settings of hashed_route.
struct hashed_route_settings {
    bucket_kind kind = bucket_kind::hash; ///< how cells become buckets
    uint m = 4;                           ///< m x m slots per bucket, 1 to 16; of 16 x 16 the last stays empty
    uint buckets = 0;        ///< hash: their number; 0: twice as many as would hold all photons in full buckets
    uint seed = 0;           ///< of the order in which photons are drawn
    uint parts = every_part; ///< other parts of the light than these are left out
};

/// The result of hashed_route. Every photon given is in it once: in `photons`, `dropped`, `invalid` or `left_out`.
template <backend B>
struct routed_survivors {
    photongrid::photons<B> photons;    ///< bucket by bucket, in draw order; powers, W, include what they stand for
    buffer_of<B, uint> list;           ///< per survivor: its index in the photons that were given
    buffer_of<B, glm::uvec2> buckets;  ///< per bucket: x: its first survivor, y: survivors
    buffer_of<B, uint> arrived;        ///< per bucket: number of photons destined for it
    buffer_of<B, glm::vec4> surpluses; ///< per bucket: w: power, W, all channels, of photons that it dropped
    uint occupied_cells = 0;           ///< rank: virtual cells that hold photons; hash: 0, not known
    uint overflowing_buckets = 0;      ///< buckets that received more photons than they have slots
    uint dropped = 0;                  ///< photons without a slot
    uint invalid = 0;                  ///< photons with a NaN or infinite position or power
    uint left_out = 0;                 ///< valid photons of another part of the light
};

namespace detail {
    inline constexpr routing_words hashed_route_words{
        "hashed_route", "bucket", "Use fewer buckets, a smaller m, or bucket_kind::hash"};

    inline void check_hashed_route(const virtual_grid& g, const hashed_route_settings& s)
    {
        check_virtual_cells("hashed_route: grid", glm::uvec3(g.axes.resolution));
        check_slots(s.m, hashed_route_words);
        if (s.kind != bucket_kind::rank && s.kind != bucket_kind::hash)
            throw std::invalid_argument("hashed_route: kind: " + std::to_string(static_cast<int>(s.kind))
                + "; it must be bucket_kind::rank or bucket_kind::hash");
        if (s.kind == bucket_kind::rank && s.buckets != 0)
            throw std::invalid_argument("hashed_route: buckets: " + std::to_string(s.buckets)
                + "; with bucket_kind::rank there are as many as cells hold photons, so leave it 0");
    }

    /// The number of buckets for so many photons: twice as many as would hold all in full buckets, so that few overflow
    /// where photons spread evenly over many cells.
    inline uint default_buckets(uint photons, uint capacity)
    {
        const std::uint64_t buckets = 2 * ((std::uint64_t{photons} + capacity - 1) / capacity);
        return static_cast<uint>(std::clamp<std::uint64_t>(buckets, 1, 1u << 31));
    }

    /// The last of `sums`; 0 if there is none.
    template <backend B>
    uint last_of(B& device, const buffer_of<B, uint>& sums)
    {
        if (sums.size() == 0)
            return 0;
        const std::vector<glm::uvec2> place{{0, static_cast<uint>(sums.size()) - 1}};
        auto last = device.template make<uint>(1);
        device.template run<kernels::reordered>(1, {}, reads(upload(device, place), sums), writes(last));
        return device.download(last)[0];
    }

    /// Per photon: the rank of its cell among the occupied ones; NONE if no map holds it. `held`: photons that a map
    /// holds. `occupied`: how many cells are.
    template <backend B>
    buffer_of<B, uint> ranked_buckets(
        B& device, const photons<B>& p, const virtual_grid& g, uint held, uint parts, uint& occupied)
    {
        const uint n = p.size();
        auto cells = device.template make<glm::uvec2>(held);
        auto begins = device.template make<uint>(held);
        {
            auto pairs = device.template make<glm::uvec2>(n == 0 ? 0 : std::bit_ceil(n)); // with the sort's padding
            auto order = device.template make<uint>(n);
            auto next = device.template make<uint>(n);
            for (const bool high : {false, true}) {
                device.template run<kernels::cell_word>({pairs.size(), 0, high ? 1u : 0u},
                    {.grid = g.axes, .photons = n, .parts = parts}, reads(p.positions, p.powers, order), writes(pairs));
                bitonic_sort(device, pairs);
                if (high)
                    device.template run<kernels::reordered>(n, {}, reads(pairs, order), writes(next));
                else
                    device.template run<kernels::pair_value>(n, {}, reads(pairs), writes(next));
                std::swap(order, next);
            }
            device.template run<kernels::begins_cell>(
                held, {.grid = g.axes}, reads(p.positions, order), writes(cells, begins));
        }
        const auto sums = prefix_sums(device, begins);
        occupied = last_of(device, sums);
        if (occupied > held)
            throw backend_error(device.caps().backend + ": hashed_route: " + std::to_string(occupied) + " cells hold "
                + std::to_string(held) + " photons; the device computed them wrongly");
        auto bucket = device.template make<uint>(n);
        device.template run<kernels::ranked_bucket>(n, {.grid = g.axes, .held = held, .parts = parts},
            reads(p.positions, p.powers, cells, sums), writes(bucket));
        return bucket;
    }
} // namespace detail

/// Thins photons to at most min(m * m, 255) per bucket of a virtual grid and lets the survivors stand for the others
/// (section 4.4 of the paper). It consumes the photons. `seed` decides which survive: those of a bucket are a uniform
/// sample, without replacement, of all that came to it.
///
/// `rank` conserves the power of each cell per channel, to 5e-4 for 70,000 equal photons in a cell. It takes the passes
/// of two sorts, and has as many buckets as cells hold photons.
///
/// `hash` keeps sums over photons unbiased. Let y_j be what photon j of a bucket adds to a sum: its power, if the sum
/// is the power of a cell and j lies in it; its filtered power per area, if the sum is an irradiance within a given
/// radius; else 0. Of the bucket's N photons K survive, and each counts N/K times (Horvitz and Thompson 1952). The mean
/// of the sum over seeds is then the sum over all photons, and each bucket adds the variance N^2 (1 - K/N) S^2 / K to
/// it, where S^2 is the sample variance of its N values y_j, with the divisor N - 1.
///
/// The standard error of an estimate from survivors (knn_estimates::standard_error) covers this beside the noise of the
/// photons themselves, if the radius is given (fixed_radius) and no power is negative. Its square is the sum of the
/// survivors' squared y_j N/K, with the mean N/K times the sum of all y_j^2. This exceeds the sum of y_j^2, the
/// variance of the unthinned Poisson process, by (N/K - 1) times that sum, and the variance above is at most that:
/// equal if one y_j differs from 0, zero if all are equal. Where the k-th photon sets the radius, there are fewer
/// photons, so the radius grows, and the bound holds only approximately.
///
/// With m = 1, `hash` is the stochastic hashing of Hachisuka and Jensen (Parallel Progressive Photon Mapping on GPUs,
/// SIGGRAPH Asia 2010 sketches): an entry of the table keeps one photon and the number of those that came.
///
/// Memory while it runs, beside the photons: about 4 min(m * m, 255) + 80 bytes per bucket and 28 per photon; rank:
/// 4 min(m * m, 255) + 190 and 52.
/// \throws std::invalid_argument for m outside 1 to 16, a grid that make_virtual_grid did not make, a number of buckets
///         with `rank`, or more than 2^27 photons; backend_error if buckets x slots exceed the device's limit.
/// \snippet snippets.cpp hashed_route
template <backend B>
routed_survivors<B> hashed_route(B& device, photons<B> p, const virtual_grid& g, const hashed_route_settings& settings)
{
    detail::check_hashed_route(g, settings);
    const auto& s = settings;
    const uint n = p.size(), capacity = route_capacity(s.m);
    const bool ranked = s.kind == bucket_kind::rank;
    // Redistribution needs exact powers, as in stencil_route; weights need exact counts only.
    const uint sums = ranked || n > (1u << 24) ? 8 : 1;
    detail::check_route_count(n, sums, detail::hashed_route_words);
    routed_survivors<B> r;
    r.invalid = detail::checked_count<kernels::invalid_photon>(device, n, {}, reads(p.positions, p.powers));
    const uint held
        = detail::checked_count<kernels::counted_photon>(device, n, {.parts = s.parts}, reads(p.positions, p.powers));
    if (held > n - r.invalid)
        throw backend_error(device.caps().backend + ": hashed_route: of " + std::to_string(n) + " photons "
            + std::to_string(held) + " are valid and " + std::to_string(r.invalid)
            + " are not; the device counted wrongly");
    r.left_out = n - r.invalid - held;

    uint buckets = s.buckets != 0 ? s.buckets : detail::default_buckets(held, capacity);
    buffer_of<B, uint> bucket; // per photon
    if (ranked) {
        bucket = detail::ranked_buckets(device, p, g, held, s.parts, r.occupied_cells);
        buckets = std::max(r.occupied_cells, 1u);
    }
    detail::check_room(device.caps(), buckets, capacity, sums, detail::hashed_route_words);
    if (!ranked) {
        bucket = device.template make<uint>(n);
        device.template run<kernels::hashed_bucket>(
            n, {.grid = g.axes, .buckets = buckets, .parts = s.parts}, reads(p.positions, p.powers), writes(bucket));
    }

    buffer_of<B, glm::vec4> scales;
    auto routed = detail::route_draws<kernels::route_by_bucket>(
        device, p, {.photons = n, .seed = s.seed}, reads(bucket, p.powers), {buckets, s.m, sums, ranked}, scales);
    r.overflowing_buckets = static_cast<uint>(routed.overflowing_cells);
    {
        auto kept = device.template make<uint>(buckets);
        device.template run<kernels::pair_value>(buckets, {}, reads(routed.cells), writes(kept));
        const auto kept_so_far = prefix_sums(device, kept);
        const uint survivors = detail::last_of(device, kept_so_far);
        if (survivors > held)
            throw backend_error(device.caps().backend + ": hashed_route: of " + std::to_string(held) + " photons "
                + std::to_string(survivors) + " survive; the device computed them wrongly");
        r.dropped = held - survivors;
        r.buckets = device.template make<glm::uvec2>(buckets);
        device.template run<kernels::packed_cell>(buckets, {}, reads(kept_so_far, kept), writes(r.buckets));
        r.list = device.template make<uint>(survivors);
        auto entries = device.template make<uint>(survivors); // 1 each
        device.template run<kernels::packed_photon>(
            survivors, {.cells = buckets}, reads(kept_so_far, routed.cells, routed.list), writes(r.list, entries));
    }
    auto powers = device.template make<glm::vec4>(r.list.size());
    device.template run<kernels::survivor_power>(
        r.list.size(), {}, reads(r.list, bucket, p.powers, scales, routed.surpluses), writes(powers));
    p.powers = {};
    detail::reorder(device, p, r.list); // the other attributes
    p.powers = std::move(powers);
    r.photons = std::move(p);
    r.arrived = std::move(routed.arrived);
    r.surpluses = std::move(routed.surpluses);
    return r;
}

/// The power, W, all channels together, of photons that hashed_route dropped, for which the survivors stand. Reads the
/// surpluses back.
/// \throws backend_error if the device fails.
/// \snippet snippets.cpp dropped_power
template <backend B>
double redistributed_power(B& device, const routed_survivors<B>& survivors)
{
    return detail::sum_of_w(device, survivors.surpluses);
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
