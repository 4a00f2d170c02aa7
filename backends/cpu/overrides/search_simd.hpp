// SIMD code of the searches exact_k and fixed_radius, and of at_least_k in block maps. Included once per instruction
// set, so it has no include guard; other files include simd.hpp.
//
// Queries that are close together form packets. The photons near a packet, from all rows of cells or blocks that can
// hold any, are copied to contiguous memory once, so that each query reads full registers of these photons only. Each
// query scans them twice: to find the k-th squared distance, and to compute the weighted sums.
//
// If a query point moves by s, the distance to its k-th nearest photon changes by at most s. So that distance lies in a
// narrow band around the distance of the query before: photons nearer than the band are counted, those in the band are
// kept, and the k-th is selected among these few. The counts show whether the k-th is in the band. If not, the scan is
// repeated without the band; if the packet's radius is too small, a new packet is made. The file is long because the
// steps of this search are of use to no other.
#include <photongrid/backends/cpu/overrides/grow_simd.hpp>
#include <photongrid/estimate/host_guess.hpp>

#include <bit>

#include <photongrid/backend/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Computes the squared distance of every photon, counts those up to low2, and keeps the distances above low2 and up to
/// high2. Returns {counted, kept}.
template <int POLICIES>
HWY_INLINE glm::uvec2 scan(const search_job& j, const query& at, float low2, float high2, const packet& near)
{
    const floats d;
    const std::size_t width = hn::Lanes(d),
                      n = (near.size() + lanes - 1) / lanes * lanes; // including the padding, which the sums read
    float *const distances = near.of(packet::squared_distance), *const kept = near.of(packet::kept);
    const query_lanes q(at);
    const photon_vectors photons = near.photons();
    const auto low = hn::Set(d, low2), high = hn::Set(d, high2);
    std::size_t counted = 0, k = 0;
    for (std::size_t i = 0; i < n; i += width) {
        const auto d2 = squared_distances<POLICIES>(j, q, photons, i);
        hn::Store(d2, d, distances + i);
        const auto nearer = hn::Le(d2, low);
        counted += hn::CountTrue(d, nearer);
        k += store_some(d, d2, hn::AndNot(nearer, hn::Le(d2, high)), kept + k);
    }
    return {static_cast<uint>(counted), static_cast<uint>(k)};
}

/// The n-th smallest (from 1) of `count` numbers that are above low (or 0) and at most high. If they are evenly
/// distributed, a few rounds of interpolation and counting find a pivot that n or n - 1 of them do not exceed. `values`
/// is overwritten, up to four registers' width past its end.
HWY_INLINE float nth_smallest(float* values, std::size_t count, std::size_t n, float low, float high)
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

/// Lists the photons within the radius, nearest first, from the distances of scan(). `keys` is scratch. It is not
/// inlined, because sorting would take registers from the search for estimates.
HWY_NOINLINE inline void list(
    const search_job& j, uint point, chosen_radius r, const packet& near, std::vector<std::uint64_t>& keys)
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

/// A first guess at the k-th squared distance, from cell counts or boxes.
inline float guess(const search_job& j, uint point)
{
    if (j.levels > 0)
        return std::min(guessed_by_boxes(j, glm::vec3(j.points[point])), j.max_radius2);
    return detail::guessed_radius2(j.cells_of, j.cells, glm::vec3(j.points[point]), j.k, j.max_radius2);
}

inline float distance_between(const glm::vec3& a, const glm::vec3& b)
{
    const float x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
    return std::sqrt(x * x + y * y + z * z);
}

/// Searches for the points order[begin] to order[end - 1]. It is one function, because most of its variables pass from
/// point to point and from packet to packet.
template <int POLICIES>
HWY_NOINLINE void search_points(const search_job& j, std::size_t begin, std::size_t end)
{
    constexpr float surplus = 0.06f; // relative margin of a packet's radius over the last k-th distance
    packet near;
    std::vector<uint> at_radius;
    std::vector<std::uint64_t> keys;
    query last;
    float last_radius = -1; // distance of the last query's k-th photon; none: -1
    float expected = -1;    // the distance to expect for the next query; -1: derive it from last_radius
    const bool exact = j.search != search_kind::fixed_radius, // finds the k-th distance
        grows = j.search == search_kind::at_least_k;          // and takes the next radius of a series
    const float max_radius = std::sqrt(j.max_radius2);
    float step = 0; // mean distance between consecutive points
    for (std::size_t o = begin + 1; o < end; ++o)
        step += distance_between(glm::vec3(j.points[j.order[o - 1]]), glm::vec3(j.points[j.order[o]]));
    step /= static_cast<float>(std::max<std::size_t>(end - begin, 2) - 1);
    for (std::size_t o = begin; o < end;) {
        const uint first = j.order[o];
        if (!needs_estimate(j, first)) {
            if (j.ids != nullptr)
                end_list(j, first, 0);
            else
                finish(j, first, {j.max_radius2, false}, {}, 0);
            ++o;
            continue;
        }
        bool guessed = false;
        if (!exact)
            expected = max_radius;
        else if (expected < 0 && last_radius > 0)
            expected
                = last_radius + std::min(surplus * last_radius, distance_between(glm::vec3(j.points[first]), last.at));
        else if (expected < 0) {
            expected = std::sqrt(1.3f * guess(j, first));
            guessed = true;
        }
        expected = std::min(expected, max_radius);

        // The packet: the next points, as long as they are close together. Larger packets need fewer copies, but have
        // more photons that are too far from most of their points. The total cost is least if the packet's extent is
        // proportional to the power 2/3 of the points' distance.
        const float relative_step = std::min(step / expected, 1.0f);
        const float widest = 2 * 1.4f * std::cbrt(relative_step * relative_step) * expected;
        glm::vec3 low(j.points[first]), high = low;
        std::size_t past = o + 1;
        for (; past < end; ++past) {
            const uint point = j.order[past];
            if (!needs_estimate(j, point))
                break;
            const glm::vec3 l = glm::min(low, glm::vec3(j.points[point])),
                            h = glm::max(high, glm::vec3(j.points[point]));
            if (!(distance_between(l, h) <= widest))
                break;
            low = l;
            high = h;
        }
        const glm::vec3 center = 0.5f * low + 0.5f * high;
        float packet_radius = expected;
        for (std::size_t i = o; i < past; ++i)
            packet_radius
                = std::max(packet_radius, expected + distance_between(glm::vec3(j.points[j.order[i]]), center));
        uint visited = static_cast<uint>(near.fill(j, center, packet_radius));

        const float begun_with = expected;
        expected = -1;
        for (; o < past; ++o) {
            const uint point = j.order[o];
            query q{glm::vec3(j.points[point]), glm::vec3(0)};
            if (POLICIES != 0)
                q.normal = glm::vec3(j.point_normals[point]);
            // The packet contains all photons within this distance of the point.
            const float sure = std::max((packet_radius - distance_between(q.at, center) * 1.000001f) * 0.999998f, 0.0f);
            const float sure2 = std::min(begun_with >= max_radius ? j.max_radius2 : sure * sure, j.max_radius2);
            chosen_radius r{j.max_radius2, false};
            float kth2 = -1; // squared distance of the k-th photon; none: -1
            float low2 = -1, high2 = sure2;
            if (exact && last_radius > 0 && (POLICIES == 0 || q.normal == last.normal)) {
                // The band. A wrong band costs time only.
                float moved = distance_between(q.at, last.at);
                if (POLICIES == 2) {
                    const glm::vec3 move(q.at.x - last.at.x, q.at.y - last.at.y, q.at.z - last.at.z);
                    const float h = move.x * q.normal.x + move.y * q.normal.y + move.z * q.normal.z;
                    moved = std::sqrt(moved * moved + j.flattening * (h * h));
                }
                moved += 1e-6f * last_radius;
                if (moved < 0.5f * last_radius) {
                    low2 = (last_radius - moved) * (last_radius - moved);
                    high2 = std::min(sure2, (last_radius + moved) * (last_radius + moved));
                }
            }
            glm::uvec2 found = scan<POLICIES>(j, q, low2, high2, near);
            visited += static_cast<uint>(near.size());
            if (exact) {
                if (found.x >= j.k || (found.x + found.y < j.k && (low2 >= 0 || high2 < sure2))) {
                    low2 = -1;
                    high2 = sure2;
                    found = scan<POLICIES>(j, q, low2, high2, near);
                    visited += static_cast<uint>(near.size());
                }
                if (found.x + found.y >= j.k) {
                    kth2 = nth_smallest(near.of(packet::kept), found.y, j.k - found.x, std::max(low2, 0.0f), high2);
                    r = {kth2, true};
                    if (grows)
                        r = {std::min(kernels::next_in_series(kth2), j.max_radius2), false};
                    if (r.radius2 > sure2) { // start a new packet here
                        expected = std::sqrt(r.radius2) * 1.00001f;
                        break;
                    }
                } else if (sure2 < j.max_radius2) {
                    // The packet's radius is too small: start a new packet here.
                    const float growth
                        = 1.2f * static_cast<float>(j.k) / static_cast<float>(std::max(found.x + found.y, 1u));
                    expected = std::max(begun_with * std::sqrt(std::clamp(growth, 1.3f, 8.0f)), 1e-15f);
                    if (growth > 4 && !guessed)
                        expected = std::max(expected, std::sqrt(1.3f * guess(j, point)));
                    break;
                }
            }
            if (j.ids != nullptr)
                list(j, point, r, near, keys);
            else
                finish(j, point, r,
                    j.errors ? gather<true>(j, r, near, at_radius) : gather<false>(j, r, near, at_radius), visited);
            visited = 0;
            last_radius = kth2 >= 0 ? std::sqrt(kth2) : -1;
            last = q;
            if (kth2 >= 0 && last_radius < 0.6f * begun_with) {
                ++o;
                break; // this packet has many more photons than needed
            }
        }
    }
}

template <int POLICIES>
HWY_INLINE void search_or_grow(const search_job& j, std::size_t begin, std::size_t end)
{
    if (j.search == search_kind::at_least_k && j.levels == 0)
        grow_points<POLICIES>(j, begin, end);
    else
        search_points<POLICIES>(j, begin, end);
}

/// Searches for the points order[begin] to order[end - 1].
inline void search_block(const search_job& j, std::size_t begin, std::size_t end)
{
    if (j.flattening > 0 || j.needs_photon_normals)
        search_or_grow<2>(j, begin, end);
    else if (j.side)
        search_or_grow<1>(j, begin, end);
    else
        search_or_grow<0>(j, begin, end);
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/backend/exact_end.hpp>
