// SIMD code of the searches exact_k and fixed_radius, and of at_least_k in block maps; nearest_simd.hpp has exact_k for
// the nearest photon alone in block maps. Included once per instruction set, so it has no include guard; other files
// include simd.hpp.
//
// Queries that are close together form packets. The photons near a packet, from all rows of cells or blocks that can
// hold any, are copied to contiguous memory once, so that each query reads full registers of these photons only. Each
// query scans them twice: to find the k-th squared distance, and to compute the weighted sums.
//
// If a query point moves by s, the distance to its k-th nearest photon changes by at most s. So that distance lies in a
// narrow band around the distance of the query before: photons nearer than the band are counted, those in the band are
// kept, and the k-th is selected among these few. The counts show whether the k-th is in the band. If not, the scan is
// repeated without the band; if the packet's radius is too small, a new packet is made.
//
// In block maps, points are searched alone (tree_simd.hpp) where a packet would hold few points, or photons much denser
// than expected.
#include <photongrid/backends/cpu/overrides/nearest_simd.hpp>
#include <photongrid/estimate/host_guess.hpp>

#include <bit>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Computes the squared distance of every photon, counts those up to low2, and keeps the distances above low2 and up to
/// high2. Returns {counted, kept}.
template <int POLICIES>
HWY_NOINLINE glm::uvec2 scan(const search_job& j, const query& at, float low2, float high2, const packet& near)
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

inline float distance_between(const glm::vec3& a, const glm::vec3& b)
{
    const float x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
    return std::sqrt(x * x + y * y + z * z);
}

/// How far at most the distance of the k-th photon changes from one point to another with the same normal.
template <int POLICIES>
HWY_INLINE float band_width(const search_job& j, const query& from, const query& to)
{
    const glm::vec3 move(to.at.x - from.at.x, to.at.y - from.at.y, to.at.z - from.at.z);
    float moved2 = move.x * move.x + move.y * move.y + move.z * move.z;
    if (POLICIES == 2) {
        const float h = move.x * to.normal.x + move.y * to.normal.y + move.z * to.normal.z;
        moved2 += j.flattening * (h * h);
    }
    return std::sqrt(moved2);
}

/// A first guess at the k-th squared distance in a grid map, from cell counts.
inline float guess(const search_job& j, uint point)
{
    return detail::guessed_radius2(j.cells_of, j.cells, glm::vec3(j.points[point]), j.k, j.max_radius2);
}

/// The given squared radius of a point, or the largest one allowed.
inline float given_radius2(const search_job& j, uint point)
{
    return j.radii_at_points ? std::min(j.points[point].w, j.max_radius2) : j.max_radius2;
}

/// Searches for the points order[begin] to order[end - 1].
template <int POLICIES>
HWY_NOINLINE void search_points(const search_job& j, std::size_t begin, std::size_t end)
{
    constexpr float surplus = 0.06f; // relative margin of a packet's radius over the last k-th distance
    // In block maps packets of fewer points are faster alone.
    constexpr uint few_points = 3;
    packet near;
    result_scratch scratch;
    query last;
    float last_radius = -1;          // distance of the last query's k-th photon; none: -1
    float expected = -1;             // the distance to expect for the next query; -1: derive it from last_radius
    std::size_t alone_until = begin; // points before it are searched alone
    const bool exact = j.search != search_kind::fixed_radius, // finds the k-th distance
        grows = j.search == search_kind::at_least_k,          // and takes the next radius of a series
        in_tree = j.levels > 0;
    const float max_radius = std::sqrt(j.max_radius2);
    const auto search_alone = [&](const query& q, uint point) HWY_ATTR {
        float bound2 = j.max_radius2;
        if (exact && last_radius >= 0 && (POLICIES == 0 || q.normal == last.normal)) {
            const float bound = (last_radius + band_width<POLICIES>(j, last, q)) * 1.000001f;
            bound2 = std::min(bound2, bound * bound + std::numeric_limits<float>::min());
            if (grows)
                bound2 = std::min(kernels::next_in_series(bound2), j.max_radius2);
        }
        const tree_result found = search_tree<POLICIES>(j, q, bound2, near);
        if (j.ids == nullptr)
            near.fetch_powers(j);
        store_result(j, point, found.radius, near, found.visited, scratch);
        last_radius = found.kth2 >= 0 ? std::sqrt(found.kth2) : -1;
        last = q;
    };
    // The photons near the last point and this one lie close enough together for a packet.
    const auto suits_packet
        = [&](const glm::vec3& at) { return last_radius > 0 && distance_between(at, last.at) < 2 * last_radius; };
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
        if (in_tree && (o < alone_until || (exact && !suits_packet(glm::vec3(j.points[first]))))) {
            search_alone(query_at<POLICIES>(j, first), first);
            expected = -1;
            ++o;
            continue;
        }
        bool guessed = false;
        if (!exact)
            expected = std::sqrt(given_radius2(j, first));
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
            if (j.radii_at_points && !(given_radius2(j, point) <= 2 * expected * expected))
                break; // its photons are too many for the others
            low = l;
            high = h;
        }
        if (in_tree && exact && past - o < few_points) {
            alone_until = past;
            continue;
        }
        const glm::vec3 center = 0.5f * low + 0.5f * high;
        float packet_radius = expected;
        for (std::size_t i = o; i < past; ++i) {
            const uint point = j.order[i];
            const float own = j.radii_at_points ? std::sqrt(given_radius2(j, point)) : expected;
            packet_radius = std::max(packet_radius, own + distance_between(glm::vec3(j.points[point]), center));
        }
        // Where photons get much denser near the points, a packet has many more than the points need.
        const std::size_t most
            = in_tree && exact ? 512 + 16 * std::size_t{j.k} : std::numeric_limits<std::size_t>::max();
        uint visited = static_cast<uint>(near.fill(j, center, packet_radius, most));
        if (visited > most) {
            alone_until = past;
            continue;
        }

        const float begun_with = expected;
        expected = -1;
        for (; o < past; ++o) {
            const uint point = j.order[o];
            const query q = query_at<POLICIES>(j, point);
            // The packet contains all photons within this distance of the point.
            const float sure = std::max((packet_radius - distance_between(q.at, center) * 1.000001f) * 0.999998f, 0.0f);
            const float limit2 = exact ? j.max_radius2 : given_radius2(j, point);
            const float sure2 = exact && begun_with < max_radius ? std::min(sure * sure, limit2) : limit2;
            chosen_radius r{limit2, false};
            float kth2 = -1; // squared distance of the k-th photon; none: -1
            float low2 = -1, high2 = sure2;
            if (exact && last_radius > 0 && (POLICIES == 0 || q.normal == last.normal)) {
                // The band. A wrong band costs time only.
                const float moved = band_width<POLICIES>(j, last, q) + 1e-6f * last_radius;
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
                    if (growth > 4 && in_tree)
                        alone_until = o + 1;
                    else if (growth > 4 && !guessed)
                        expected = std::max(expected, std::sqrt(1.3f * guess(j, point)));
                    break;
                }
            }
            store_result(j, point, r, near, visited, scratch);
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
    else if (POLICIES == 0 && j.search == search_kind::exact_k && j.k == 1 && j.levels > 0)
        find_nearest(j, begin, end);
    else
        search_points<POLICIES>(j, begin, end);
}

/// Searches for the points order[begin] to order[end - 1].
inline void search_block(const search_job& j, std::size_t begin, std::size_t end)
{
    if (j.flattening > 0 || j.needs_photon_normals || j.half_spaces)
        search_or_grow<2>(j, begin, end);
    else if (j.side)
        search_or_grow<1>(j, begin, end);
    else
        search_or_grow<0>(j, begin, end);
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
