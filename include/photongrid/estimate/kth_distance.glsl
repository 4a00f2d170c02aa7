// The squared distance of the k-th nearest photon, without an array of k photons. The first scan of the photons within
// a radius counts how many lie within each of eight pivot distances, which brackets the k-th. The second scan has one
// pivot, at the distance that the k-th has if the photons of the bracket are evenly distributed, and keeps the four
// photons nearest to the pivot on either side, in order. Usually the k-th is one of them. If not, they narrow the
// bracket for another scan. After six scans the pivot bisects the bracket's integer keys, so that about thirty more
// scans suffice.
//
// The result is the squared distance of a photon, independent of the pivots and therefore the same on every device.
#include <photongrid/core/none.glsl>
#include <photongrid/map/block_tree.glsl>
#include <photongrid/map/grid.glsl>
#include <photongrid/estimate/distance_key.glsl>
#include <photongrid/estimate/kth_state.glsl>
#include <photongrid/estimate/row_cursor.glsl>
#include <photongrid/estimate/search_tally.glsl>

struct Params {
    Grid grid;
    vec4 leaks;        // see photon_distance.glsl
    uint k;            // photons sought
    float max_radius2; // m^2
    uint visits;       // the most photons to examine in a pass ...
    uint ranges;       // ... and the most rows of cells or boxes
    uint levels;       // block map: of its tree
    uint in_blocks;    // block map: photons in blocks
};
PARAMS(Params)
#include <photongrid/estimate/search_inputs.glsl>
IN_GROUPS(3)
INPUT(6, vec4, boxes)      // block map: see block_tree.glsl
STATE(0, vec4, pivots)   // see kth_state.glsl, also for bracket and tally
STATE(1, uvec4, inner)   // COUNTING: photons within pivots 1 to 4; CLOSING_IN: the four largest keys up to the pivot
STATE(2, uvec4, outer)   // COUNTING: photons within pivots 5 to 8; CLOSING_IN: the four smallest keys beyond the pivot
STATE(3, uvec4, bracket)
STATE(4, uvec4, cursor)  // see row_cursor.glsl
STATE(5, uvec4, tally)

#include <photongrid/estimate/photon_distance.glsl>
#include <photongrid/estimate/search_rows.glsl>
#include <photongrid/estimate/search_blocks.glsl>
#include <photongrid/estimate/photon_walk.glsl>

bool done()
{
    return kth_phase(tally) == FOUND;
}

// The n-th component, from 0.
uint component(uvec4 v, uint n)
{
    return n == 0u ? v.x : n == 1u ? v.y : n == 2u ? v.z : v.w;
}

// The bracket, narrowed by the count of photons within one pivot.
uvec4 narrowed(uvec4 between, float pivot, uint count)
{
    uint key = key_of(pivot);
    if (count < args.k)
        return key > low_key(between) ? kth_bracket(key, high_key(between), count, up_to_high(between)) : between;
    return up_to_high(between) == NONE || key < high_key(between)
        ? kth_bracket(low_key(between), key, up_to_low(between), count)
        : between;
}

float within_limit(float radius2)
{
    return min(radius2, args.max_radius2);
}

// 1 for each of four pivots that the photon lies within.
uvec4 counted(float d2, vec4 limits)
{
    return uvec4(d2 <= limits.x ? 1u : 0u, d2 <= limits.y ? 1u : 0u,
        d2 <= limits.z ? 1u : 0u, d2 <= limits.w ? 1u : 0u);
}

// Inserts a key into the four largest so far, descending, or the four smallest so far, ascending.
uvec4 largest(uvec4 so_far, uint key)
{
    return uvec4(max(so_far.x, key), max(so_far.y, min(so_far.x, key)),
        max(so_far.z, min(so_far.y, key)), max(so_far.w, min(so_far.z, key)));
}
uvec4 smallest(uvec4 so_far, uint key)
{
    return uvec4(min(so_far.x, key), min(so_far.y, max(so_far.x, key)),
        min(so_far.z, max(so_far.y, key)), min(so_far.w, max(so_far.z, key)));
}

// What a query has found: see kth_state.glsl.
struct Kth {
    float pivot;
    float span;
    uvec4 below;
    uvec4 beyond;
    uvec4 between;
    uint within;
    uint scans;
    uint phase;
};

// After a scan that counted the photons within eight pivots: narrows the bracket.
Kth after_counting(Kth s, vec4 near_pivots, vec4 far_pivots)
{
    s.between = narrowed(s.between, near_pivots.x, s.below.x);
    s.between = narrowed(s.between, near_pivots.y, s.below.y);
    s.between = narrowed(s.between, near_pivots.z, s.below.z);
    s.between = narrowed(s.between, near_pivots.w, s.below.w);
    s.between = narrowed(s.between, far_pivots.x, s.beyond.x);
    s.between = narrowed(s.between, far_pivots.y, s.beyond.y);
    s.between = narrowed(s.between, far_pivots.z, s.beyond.z);
    s.between = narrowed(s.between, far_pivots.w, s.beyond.w);
    s.phase = CLOSING_IN;
    if (up_to_high(s.between) == NONE) {
        // Fewer than k photons lie within the widest pivot. Scan wider, unless it already reached max_radius: then
        // fewer than k exist.
        s.phase = far_pivots.w < args.max_radius2 ? COUNTING : FOUND;
        s.within = s.beyond.w;
        s.scans = 0u;
        precise float growth = 1.1f * (float(args.k) / float(max(s.beyond.w, 1u)));
        s.pivot = max(far_pivots.w, 0.0f);
        s.span = max(s.pivot * (min(growth, 16.0f) - 1.0f), 1e-30f);
    }
    return s;
}

// The k-th lies within the pivot, `before` places before the last photon there.
Kth found_within(Kth s)
{
    uvec4 between = s.between;
    uvec4 below = s.below;
    uint before = s.within - args.k;
    uint kth = component(below, min(before, 3u));
    if (before < 4u) {
        s.phase = FOUND;
        s.within = args.k + (before > 0u && component(below, before - 1u) == kth ? 1u : 0u);
        s.between = kth_bracket(low_key(between), kth, up_to_low(between), up_to_high(between));
    } else {
        uint farther = (below.x > kth ? 1u : 0u) + (below.y > kth ? 1u : 0u) + (below.z > kth ? 1u : 0u);
        s.between = kth_bracket(low_key(between), kth, up_to_low(between), s.within - farther);
    }
    return s;
}

// The k-th lies beyond the pivot, `before` places behind the first photon there. `middle`: the pivot's key.
Kth found_beyond(Kth s, uint middle)
{
    uvec4 between = s.between;
    uvec4 beyond = s.beyond;
    uint before = args.k - s.within - 1u;
    uint kth = component(beyond, min(before, 3u));
    bool one_key = beyond.x == high_key(between); // all photons beyond the pivot have it
    if (before < 3u || one_key) {
        s.phase = FOUND;
        s.within
            = one_key ? up_to_high(between) : args.k + (component(beyond, before + 1u) == kth ? 1u : 0u);
        s.between = kth_bracket(low_key(between), kth, up_to_low(between), up_to_high(between));
    } else {
        // More photons than the fourth may have its key, so the bracket begins before it.
        uint nearer = (beyond.x < kth ? 1u : 0u) + (beyond.y < kth ? 1u : 0u) + (beyond.z < kth ? 1u : 0u);
        uint last = nearer == 0u ? middle : component(beyond, nearer - 1u);
        s.between = kth_bracket(
            max(low_key(between), last), high_key(between), s.within + nearer, up_to_high(between));
    }
    return s;
}

// Prepares the next scan: its pivot, or the end if one distance is left.
Kth next_scan(Kth s)
{
    if (s.phase != CLOSING_IN) {
        s.below = uvec4(0u, 0u, 0u, 0u);
        s.beyond = s.below;
        return s;
    }
    uint first = low_key(s.between);
    uint end = high_key(s.between);
    if (end <= first || end - first == 1u) {
        // If several photons have this distance, kth_tie.glsl chooses among them by id.
        s.phase = FOUND;
        s.within = up_to_high(s.between);
        return s;
    }
    float first2 = distance_of(first);
    float share
        = (float(args.k - up_to_low(s.between)) - 0.5f) / float(up_to_high(s.between) - up_to_low(s.between));
    precise float even = first2 + (distance_of(end) - first2) * share;
    uint next = s.scans < 6u ? key_of(even) : first + (end - first) / 2u;
    s.pivot = distance_of(min(max(next, first), end - 1u));
    s.within = up_to_low(s.between);
    s.below = uvec4(0u, 0u, 0u, 0u);
    s.beyond = uvec4(NONE, NONE, NONE, NONE);
    return s;
}

// The guess (kth_guess.glsl) is more often a little too low than too high.
vec4 pivots_at(Kth s, vec4 spans)
{
    precise vec4 at = vec4(s.pivot + spans.x * s.span, s.pivot + spans.y * s.span, s.pivot + spans.z * s.span,
        s.pivot + spans.w * s.span);
    return vec4(within_limit(at.x), within_limit(at.y), within_limit(at.z), within_limit(at.w));
}

Kth found_so_far()
{
    Kth s;
    s.pivot = pivot_base(pivots);
    s.span = pivot_span(pivots);
    s.between = bracket;
    s.within = photons_found(tally);
    s.scans = scans_of(tally);
    s.phase = min(kth_phase(tally), FOUND);
    s.below = inner;
    s.beyond = outer;
    return s;
}

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 n = normals(i);
    uvec4 c = cell_coordinates(args.grid, p);
    Kth s = found_so_far();
    uvec4 below = s.below;
    uvec4 beyond = s.beyond;
    uint visited = photons_visited(tally);

    walk_visits = args.visits;
    walk_steps = args.ranges;
    while (walk_steps > 0u && group_any(s.phase != FOUND)) {
        vec4 near_pivots = pivots_at(s, vec4(0.6f, 0.8f, 0.92f, 1.04f));
        vec4 far_pivots = pivots_at(s, vec4(1.16f, 1.3f, 1.48f, 1.7f));
        uint middle = key_of(s.pivot);
        uint low = low_key(s.between);
        float high2 = distance_of(high_key(s.between));
        float scan2 = s.phase == COUNTING ? far_pivots.w : high2;
        bool mine = joins_walk(s.phase != FOUND, p, c, scan2, in_phase(cursor, s.phase));
        vec4 from = vec4(mine ? p.x : -3.0e38f, p.y, p.z, 0.0f); // the other lanes count nothing
        while (walk_phase == COUNTING && walks_on()) {
            uint photons = next_rows();
            visited += mine ? photons : 0u;
            // No branches: they are mispredicted on a CPU and diverge on a GPU.
#define VISIT(LANE)                                           \
    {                                                         \
        float d2 = distance2_of(PHOTON_OF(LANE), from, n);    \
        below += counted(d2, near_pivots);                    \
        beyond += counted(d2, far_pivots);                    \
    }
            if (photons > 0u)
                EACH_PHOTON(photons, gather_chunk, VISIT)
#undef VISIT
        }
        while (walk_phase != COUNTING && walks_on()) {
            uint photons = next_rows();
            visited += mine ? photons : 0u;
#define VISIT(LANE)                                                                   \
    {                                                                                 \
        float d2 = distance2_of(PHOTON_OF(LANE), from, n);                            \
        uint key = key_of(d2);                                                        \
        bool inside = d2 <= high2 && key > low;                                       \
        if (GROUP_LANES > 1u || inside) {                                             \
            s.within += inside && key <= middle ? 1u : 0u;                            \
            below = largest(below, inside && key <= middle ? key : 0u);               \
            beyond = smallest(beyond, inside && key > middle ? key : NONE);           \
        }                                                                             \
    }
            if (photons > 0u)
                EACH_PHOTON(photons, gather_chunk, VISIT)
#undef VISIT
        }
        if (mine)
            cursor = walk_cursor();

        if (mine && has_walked()) {
            s.below = below;
            s.beyond = beyond;
            ++s.scans;
            if (s.phase == COUNTING)
                s = after_counting(s, near_pivots, far_pivots);
            else if (args.k <= s.within)
                s = found_within(s);
            else
                s = found_beyond(s, middle);
            s = next_scan(s);
            below = s.below;
            beyond = s.beyond;
            cursor = at_first_row();
        }
    }

    pivots = pivots_of(s.pivot, s.span);
    inner = below;
    outer = beyond;
    bracket = s.between;
    tally = kth_tally(s.within, visited, s.scans, s.phase);
}
