// SIMD code that selects and lists the photons of a packet. Included once per instruction set, so it has no include
// guard; other files include simd.hpp.
#include <photongrid/backends/cpu/overrides/bias_simd.hpp>

#include <bit>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The n-th smallest (from 1) of `count` numbers that are above low (or 0) and at most high. If they are evenly
/// distributed, a few rounds of interpolation and counting find a pivot that n or n - 1 of them do not exceed. `values`
/// is overwritten, up to four registers' width past its end.
HWY_NOINLINE inline float nth_smallest(float* values, std::size_t count, std::size_t n, float low, float high)
{
    const floats d;
    const std::size_t width = hn::Lanes(d), whole = (count + 4 * width - 1) / (4 * width) * (4 * width);
    for (std::size_t more = 0; more < 4; ++more)
        hn::StoreU(hn::Set(d, std::numeric_limits<float>::infinity()), d, values + count + more * width);
    std::size_t below = 0, up_to = count; // how many are at most low, at most high
    auto beyond = hn::Set(d, -1.0f);      // the pivot at low; -1, below all squared distances, until there is one
    for (int rounds = 0; below + 1 < n && n < up_to; ++rounds) {
        const float pivot
            = low + (high - low) * (static_cast<float>(n - below) / static_cast<float>(up_to - below + 1));
        if (rounds == 12 || !(pivot > low && pivot < high)) { // unevenly distributed, or equal
            std::nth_element(values, values + (n - 1), values + count);
            return values[n - 1];
        }
        const auto p = hn::Set(d, pivot);
        std::size_t within = 0;
        for (std::size_t i = 0; i < whole; i += 4 * width) // four registers at a time, for predictable branches
            for (std::size_t v = 0; v < 4; ++v)
                within += hn::CountTrue(d, hn::Le(hn::LoadU(d, values + i + v * width), p));
        if (n <= within) {
            up_to = within;
            high = pivot;
        } else {
            below = within;
            low = pivot;
            beyond = p;
        }
    }
    if (n == up_to) { // the largest of these
        const auto h = hn::Set(d, high);
        auto largest = hn::Set(d, -1.0f);
        for (std::size_t i = 0; i < count; i += width) {
            const auto v = hn::LoadU(d, values + i);
            largest = hn::Max(largest, hn::IfThenElse(hn::Le(v, h), v, largest));
        }
        return hn::GetLane(hn::MaxOfLanes(d, largest));
    }
    auto smallest = hn::Set(d, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < count; i += width) {
        const auto v = hn::LoadU(d, values + i);
        smallest = hn::Min(smallest, hn::IfThenElse(hn::Gt(v, beyond), v, smallest));
    }
    return hn::GetLane(hn::MinOfLanes(d, smallest));
}

/// Marks the end of a point's list after `held` entries.
inline void end_list(const search_job& j, uint point, std::size_t held)
{
    const std::size_t first = std::size_t{point} * j.k;
    std::fill(j.ids + first + held, j.ids + first + j.k, no_id);
    std::fill(j.distances2 + first + held, j.distances2 + first + j.k, std::numeric_limits<float>::infinity());
}

/// Memory that results need, kept from point to point.
struct result_scratch {
    std::vector<uint> at_radius;
    std::vector<std::uint64_t> keys;
};

/// Lists the photons within the radius, nearest first, from the distances of scan(). `keys` is scratch.
inline void list(const search_job& j, uint point, chosen_radius r, const packet& near, std::vector<std::uint64_t>& keys)
{
    const floats d;
    const uints du;
    const std::size_t width = hn::Lanes(d), n = near.size();
    const float* const distances = near.of(packet::squared_distance);
    // The photons' numbers in the packet.
    auto* const within = reinterpret_cast<uint*>(near.of(packet::kept));
    const auto radius2 = hn::Set(d, r.radius2);
    std::size_t held = 0;
    for (std::size_t i = 0; i < n; i += width) {
        const auto is_within = hn::And(hn::Le(hn::Load(d, distances + i), radius2), hn::FirstN(d, n - i));
        held += store_some(du, hn::Add(hn::Set(du, static_cast<uint>(i)), hn::Iota(du, 0)),
            hn::RebindMask(du, is_within), within + held);
    }
    // The bits of squared distances have the order of the distances; equal distances are ordered by id.
    keys.resize(held);
    for (std::size_t i = 0; i < held; ++i)
        keys[i] = std::uint64_t{std::bit_cast<uint>(distances[within[i]])} << 32 | j.list[near.index(within[i])];
    std::sort(keys.begin(), keys.end());
    held = std::min<std::size_t>(held, j.k); // there may be more at the radius
    uint* const ids = j.ids + std::size_t{point} * j.k;
    float* const distances2 = j.distances2 + std::size_t{point} * j.k;
    for (std::size_t i = 0; i < held; ++i) {
        ids[i] = static_cast<uint>(keys[i]);
        distances2[i] = std::bit_cast<float>(static_cast<uint>(keys[i] >> 32));
    }
    end_list(j, point, held);
}

/// Stores the result for a point from the packet's photons and their distances: a list, or an estimate and its bias.
/// One function for all searches, which compilers spend most of their time on if they inline it.
HWY_NOINLINE inline void store_result(
    const search_job& j, uint point, chosen_radius r, const packet& near, uint visited, result_scratch& s)
{
    if (j.ids != nullptr)
        list(j, point, r, near, s.keys);
    else
        finish(j, point, r,
            j.errors ? gather<true>(j, point, r, near, s.at_radius) : gather<false>(j, point, r, near, s.at_radius),
            visited);
    if (j.biases.bias != nullptr)
        store_bias(j, point, r, near);
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
