// The squared distance of the k-th nearest photon, without an array of k photons. The first scan of the photons within
// a radius counts how many lie within each of eight pivot distances, which brackets the k-th. The second scan has one
// pivot, at the distance that the k-th has if the photons of the bracket are evenly distributed, and keeps the four
// photons nearest to the pivot on either side, in order. Usually the k-th is one of them. If not, they narrow the
// bracket for another scan. After six scans the pivot bisects the bracket's integer keys, so that about thirty more
// scans suffice.
//
// The result is the squared distance of a photon, independent of the pivots and therefore the same on every device.
//
// The kernel is one function, because it is one state machine over local copies of the states.
#include <photongrid/backend/none.glsl>
#include <photongrid/map/grid.glsl>
#include <photongrid/estimate/distance_key.glsl>
#include <photongrid/estimate/kth_phases.glsl>

struct Params {
    Grid grid;
    vec4 leaks;        // see photon_distance.glsl
    uint k;            // photons sought
    float max_radius2; // m^2
    uint visits;       // the most photons to examine in a pass ...
    uint ranges;       // ... and the most rows of cells
};
PARAMS(Params)
#include <photongrid/estimate/search_inputs.glsl>
IN_GROUPS(3)
STATE(0, vec4, pivots)   // m^2; COUNTING: the eight pivots are x + y times the factors in the kernel; CLOSING_IN: x
STATE(1, uvec4, inner)   // COUNTING: photons within pivots 1 to 4; CLOSING_IN: the four largest keys up to the pivot
STATE(2, uvec4, outer)   // COUNTING: photons within pivots 5 to 8; CLOSING_IN: the four smallest keys beyond the pivot
STATE(3, uvec4, bracket) // x < key of the k-th <= y; z, w: photons up to x, y; w NONE: unknown
STATE(4, uvec4, cursor)  // y, z of the next row; the first photon not yet visited
STATE(5, uvec4, tally)   // photons within the pivot, if FOUND within the k-th distance; photons visited; scans; phase

#include <photongrid/estimate/photon_distance.glsl>
#include <photongrid/estimate/search_rows.glsl>
#include <photongrid/estimate/photon_walk.glsl>

bool done()
{
    return tally.w == FOUND;
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
        return key > between.x ? uvec4(key, between.y, count, between.w) : between;
    return between.w == NONE || key < between.y ? uvec4(between.x, key, between.z, count) : between;
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

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 n = normals(i);
    uvec4 c = cell_coordinates(args.grid, p);
    vec4 pivot = pivots;
    uvec4 below = inner;
    uvec4 beyond = outer;
    uvec4 between = bracket;
    uvec4 resume_at = cursor;
    uint within = tally.x;
    uint visited = tally.y;
    uint scans = tally.z;
    uint phase = tally.w <= CLOSING_IN ? tally.w : FOUND;

    walk_visits = args.visits;
    walk_steps = args.ranges;
    while (walk_steps > 0u && group_any(phase != FOUND)) {
        // The guess (kth_guess.glsl) is more often a little too low than too high.
        precise vec4 near_pivots = vec4(pivot.x + 0.6f * pivot.y, pivot.x + 0.8f * pivot.y,
            pivot.x + 0.92f * pivot.y, pivot.x + 1.04f * pivot.y);
        precise vec4 far_pivots = vec4(pivot.x + 1.16f * pivot.y, pivot.x + 1.3f * pivot.y,
            pivot.x + 1.48f * pivot.y, pivot.x + 1.7f * pivot.y);
        near_pivots = vec4(within_limit(near_pivots.x), within_limit(near_pivots.y),
            within_limit(near_pivots.z), within_limit(near_pivots.w));
        far_pivots = vec4(within_limit(far_pivots.x), within_limit(far_pivots.y),
            within_limit(far_pivots.z), within_limit(far_pivots.w));
        uint middle = key_of(pivot.x);
        float high = distance_of(between.y);
        float scan2 = phase == COUNTING ? far_pivots.w : high;
        bool mine = joins_walk(phase != FOUND, p, c, scan2, uvec4(resume_at.x, resume_at.y, resume_at.z, phase));
        vec4 from = vec4(mine ? p.x : -3.0e38f, p.y, p.z, 0.0f); // the other lanes count nothing
        while (walk_phase() == COUNTING && walks_on()) {
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
        while (walk_phase() != COUNTING && walks_on()) {
            uint photons = next_rows();
            visited += mine ? photons : 0u;
#define VISIT(LANE)                                                                   \
    {                                                                                 \
        float d2 = distance2_of(PHOTON_OF(LANE), from, n);                            \
        uint key = key_of(d2);                                                        \
        bool inside = d2 <= high && key > between.x;                                  \
        if (GROUP_LANES > 1u || inside) {                                             \
            within += inside && key <= middle ? 1u : 0u;                              \
            below = largest(below, inside && key <= middle ? key : 0u);               \
            beyond = smallest(beyond, inside && key > middle ? key : NONE);           \
        }                                                                             \
    }
            if (photons > 0u)
                EACH_PHOTON(photons, gather_chunk, VISIT)
#undef VISIT
        }
        if (mine)
            resume_at = uvec4(walk.x, walk.y, walk.z, 0u);

        if (mine && has_walked()) {
            // The scan is complete: narrow the bracket, or find the k-th.
            ++scans;
            if (phase == COUNTING) {
                between = narrowed(between, near_pivots.x, below.x);
                between = narrowed(between, near_pivots.y, below.y);
                between = narrowed(between, near_pivots.z, below.z);
                between = narrowed(between, near_pivots.w, below.w);
                between = narrowed(between, far_pivots.x, beyond.x);
                between = narrowed(between, far_pivots.y, beyond.y);
                between = narrowed(between, far_pivots.z, beyond.z);
                between = narrowed(between, far_pivots.w, beyond.w);
                if (between.w == NONE) {
                    // Fewer than k so beyond. Wider, unless that was the widest: then these are all.
                    phase = far_pivots.w < args.max_radius2 ? COUNTING : FOUND;
                    within = beyond.w;
                    scans = 0u;
                    precise float growth = 1.1f * (float(args.k) / float(max(beyond.w, 1u)));
                    float base = max(far_pivots.w, 0.0f);
                    pivot = vec4(base, max(base * (min(growth, 16.0f) - 1.0f), 1e-30f), 0.0f, 0.0f);
                } else {
                    phase = CLOSING_IN;
                }
            } else if (args.k <= within) {
                // At the pivot or before it, and `before` photons before the last of these.
                uint before = within - args.k;
                uint kth = component(below, min(before, 3u));
                if (before < 4u) {
                    phase = FOUND;
                    within = args.k + (before > 0u && component(below, before - 1u) == kth ? 1u : 0u);
                    between.y = kth;
                } else {
                    uint farther = (below.x > kth ? 1u : 0u) + (below.y > kth ? 1u : 0u) + (below.z > kth ? 1u : 0u);
                    between = uvec4(between.x, kth, between.z, within - farther);
                }
            } else {
                uint before = args.k - within - 1u;
                uint kth = component(beyond, min(before, 3u));
                if (before < 3u || beyond.x == between.y) {
                    phase = FOUND;
                    within = beyond.x == between.y ? between.w
                                                   : args.k + (component(beyond, before + 1u) == kth ? 1u : 0u);
                    between.y = kth;
                } else {
                    // Other photons may have the same distance as the fourth of these.
                    uint nearer = (beyond.x < kth ? 1u : 0u) + (beyond.y < kth ? 1u : 0u) + (beyond.z < kth ? 1u : 0u);
                    uint last = nearer == 0u ? middle : component(beyond, nearer - 1u);
                    between = uvec4(max(between.x, last), between.y, within + nearer, between.w);
                }
            }
            if (phase == CLOSING_IN) {
                if (between.y <= between.x || between.y - between.x == 1u) {
                    // One distance is left. If several photons have it, kth_tie.glsl chooses among them by id.
                    phase = FOUND;
                    within = between.w;
                } else {
                    float low = distance_of(between.x);
                    high = distance_of(between.y);
                    float share = (float(args.k - between.z) - 0.5f) / float(between.w - between.z);
                    precise float even = low + (high - low) * share;
                    uint next = scans < 6u ? key_of(even) : between.x + (between.y - between.x) / 2u;
                    pivot.x = distance_of(min(max(next, between.x), between.y - 1u));
                    within = between.z;
                    below = uvec4(0u, 0u, 0u, 0u);
                    beyond = uvec4(NONE, NONE, NONE, NONE);
                }
            } else {
                below = uvec4(0u, 0u, 0u, 0u);
                beyond = below;
            }
            resume_at = uvec4(0u, 0u, 0u, 0u);
        }
    }

    pivots = pivot;
    inner = below;
    outer = beyond;
    bracket = between;
    cursor = resume_at;
    tally = uvec4(within, visited, scans, phase);
}
