// The squared distance of the k-th nearest photon, without an array of k. A first scan of the photons within a radius counts
// how many lie within each of eight pivots, which brackets the k-th. A second lays one pivot where the k-th should be if
// the bracket's photons are spread evenly, and keeps the four photons next to it on either side, in order: the k-th is mostly
// one of these. If not, they narrow the bracket, and the next scan lays another; after a few, pivots halve the bracket's
// bits, and at most some thirty end it.
//
// The result is a photon's own squared distance, so it does not depend on pivots: it is the same on every device.
#include "grid.glsl"
#include "distance_key.glsl"

struct Params {
    Grid grid;
    vec4 leaks;        // see photon_distance.glsl
    uint wanted;       // k
    float max_radius2; // m^2
    uint visits;       // photons examined in a pass at most ...
    uint ranges;       // ... in this many rows of cells at most
};
PARAMS(Params)
SWITCH(0, SIDE)
SWITCH(1, NORMALS)
SWITCH(2, FLATTEN)
INPUT(0, vec4, points)         // xyz: query point, m
INPUT(1, vec4, normals)        // xyz: unit normal of the surface there
INPUT(2, uvec2, cells)         // x: first photon, y: count
INPUT(3, vec4, positions)      // xyz, m, cell by cell
INPUT(4, vec4, directions)
INPUT(5, vec4, photon_normals)
STATE(0, vec4, pivots)   // m^2; counting: x + y times each of the eight below; closing in: x
STATE(1, uvec4, inner)   // counting: photons within the first four pivots; closing in: keys of the four next to the pivot, descending
STATE(2, uvec4, outer)   // counting: within the last four; closing in: keys of the four beyond the pivot, ascending
STATE(3, uvec4, bracket) // the k-th key lies above x and is y at most; z and w photons lie within x and y, w: 0xFFFFFFFF: unknown
STATE(4, uvec4, cursor)  // y, z of the next row; next and end of the row being read
STATE(5, uvec4, tally)   // photons within the pivot or, found, within y: more than k where several share that distance; photons visited; scans; phase

#include "photon_distance.glsl"
#include "search_rows.glsl"

// Phases
const uint COUNTING = 0u;
const uint CLOSING_IN = 1u;
const uint FOUND = 3u;

bool done()
{
    return tally.w == FOUND;
}

// The n-th component, from 0.
uint component(uvec4 v, uint n)
{
    return n == 0u ? v.x : n == 1u ? v.y : n == 2u ? v.z : v.w;
}

// The bracket, narrowed by what one pivot counted.
uvec4 narrowed(uvec4 between, float pivot, uint count)
{
    uint key = key_of(pivot);
    if (count < args.wanted)
        return key > between.x ? uvec4(key, between.y, count, between.w) : between;
    return between.w == 0xFFFFFFFFu || key < between.y ? uvec4(between.x, key, between.z, count) : between;
}

float within_limit(float radius2)
{
    return min(radius2, args.max_radius2);
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
    uint y = cursor.x;
    uint z = cursor.y;
    uint at = cursor.z;
    uint end = cursor.w;
    uint within = tally.x;
    uint visited = tally.y;
    uint scans = tally.z;
    uint phase = tally.w <= CLOSING_IN ? tally.w : FOUND;

    uint left = args.visits;
    uint steps = args.ranges;
    while (steps > 0u && phase != FOUND) {
        // The guess is a little low more often than high (kth_guess.glsl).
        precise float pivot_0 = within_limit(pivot.x + 0.6f * pivot.y);
        precise float pivot_1 = within_limit(pivot.x + 0.8f * pivot.y);
        precise float pivot_2 = within_limit(pivot.x + 0.92f * pivot.y);
        precise float pivot_3 = within_limit(pivot.x + 1.04f * pivot.y);
        precise float pivot_4 = within_limit(pivot.x + 1.16f * pivot.y);
        precise float pivot_5 = within_limit(pivot.x + 1.3f * pivot.y);
        precise float pivot_6 = within_limit(pivot.x + 1.48f * pivot.y);
        precise float pivot_7 = within_limit(pivot.x + 1.7f * pivot.y);
        uint middle = key_of(pivot.x);
        float high = distance_of(between.y);
        float scan2 = phase == COUNTING ? pivot_7 : high;
        float radius = wider(scan2);
        uvec2 rows_y = cells_within(p.y, radius, args.grid.origin.y, args.grid.inverse_cell.y, args.grid.resolution.y);
        uvec2 rows_z = cells_within(p.z, radius, args.grid.origin.z, args.grid.inverse_cell.z, args.grid.resolution.z);
        y = max(y, rows_y.x);
        z = max(z, rows_z.x);
        while (steps > 0u && (at < end || z <= rows_z.y)) {
            --steps;
            uint stop = end - at > left ? at + left : end;
            left -= stop - at;
            visited += stop - at;
            if (phase == COUNTING) {
                // No branches: they are mispredicted on a CPU and diverge on a GPU.
                for (; at < stop; ++at) {
                    float d2 = photon_distance2(at, p, n);
                    below.x += d2 <= pivot_0 ? 1u : 0u;
                    below.y += d2 <= pivot_1 ? 1u : 0u;
                    below.z += d2 <= pivot_2 ? 1u : 0u;
                    below.w += d2 <= pivot_3 ? 1u : 0u;
                    beyond.x += d2 <= pivot_4 ? 1u : 0u;
                    beyond.y += d2 <= pivot_5 ? 1u : 0u;
                    beyond.z += d2 <= pivot_6 ? 1u : 0u;
                    beyond.w += d2 <= pivot_7 ? 1u : 0u;
                }
            } else {
                for (; at < stop; ++at) {
                    float d2 = photon_distance2(at, p, n);
                    uint key = key_of(d2);
                    if (d2 <= high && key > between.x) {
                        uint in_key = key <= middle ? key : 0u;
                        within += key <= middle ? 1u : 0u;
                        below.w = max(below.w, min(below.z, in_key));
                        below.z = max(below.z, min(below.y, in_key));
                        below.y = max(below.y, min(below.x, in_key));
                        below.x = max(below.x, in_key);
                        uint out_key = key <= middle ? 0xFFFFFFFFu : key;
                        beyond.w = min(beyond.w, max(beyond.z, out_key));
                        beyond.z = min(beyond.z, max(beyond.y, out_key));
                        beyond.y = min(beyond.y, max(beyond.x, out_key));
                        beyond.x = min(beyond.x, out_key);
                    }
                }
            }
            if (at < end) {
                steps = 0u; // budget spent
            } else if (z <= rows_z.y) {
                uvec2 row = photons_of_row(p, y, z, c, scan2);
                at = row.x;
                end = row.y;
                ++y;
                if (y > rows_y.y) {
                    y = rows_y.x;
                    ++z;
                }
            }
        }

        if (steps > 0u) {
            // The scan is whole: what does it say about the k-th?
            --steps;
            ++scans;
            if (phase == COUNTING) {
                between = narrowed(between, pivot_0, below.x);
                between = narrowed(between, pivot_1, below.y);
                between = narrowed(between, pivot_2, below.z);
                between = narrowed(between, pivot_3, below.w);
                between = narrowed(between, pivot_4, beyond.x);
                between = narrowed(between, pivot_5, beyond.y);
                between = narrowed(between, pivot_6, beyond.z);
                between = narrowed(between, pivot_7, beyond.w);
                if (between.w == 0xFFFFFFFFu) {
                    // Fewer than k so beyond. Wider, unless that was the widest: then these are all.
                    phase = pivot_7 < args.max_radius2 ? COUNTING : FOUND;
                    within = beyond.w;
                    scans = 0u;
                    precise float growth = 1.1f * (float(args.wanted) / float(max(beyond.w, 1u)));
                    float base = max(pivot_7, 0.0f);
                    pivot = vec4(base, max(base * (min(growth, 16.0f) - 1.0f), 1e-30f), 0.0f, 0.0f);
                } else {
                    phase = CLOSING_IN;
                }
            } else if (args.wanted <= within) {
                // At the pivot or before it, and `before` photons before the last of these.
                uint before = within - args.wanted;
                uint kth = component(below, min(before, 3u));
                if (before < 4u) {
                    phase = FOUND;
                    within = args.wanted + (before > 0u && component(below, before - 1u) == kth ? 1u : 0u);
                    between.y = kth;
                } else {
                    uint farther = (below.x > kth ? 1u : 0u) + (below.y > kth ? 1u : 0u) + (below.z > kth ? 1u : 0u);
                    between = uvec4(between.x, kth, between.z, within - farther);
                }
            } else {
                uint before = args.wanted - within - 1u;
                uint kth = component(beyond, min(before, 3u));
                if (before < 3u || beyond.x == between.y) {
                    phase = FOUND;
                    within = beyond.x == between.y ? between.w : args.wanted + (component(beyond, before + 1u) == kth ? 1u : 0u);
                    between.y = kth;
                } else {
                    // As beyond as all photons are known: more than these four may share the fourth's distance.
                    uint nearer = (beyond.x < kth ? 1u : 0u) + (beyond.y < kth ? 1u : 0u) + (beyond.z < kth ? 1u : 0u);
                    uint last = nearer == 0u ? middle : component(beyond, nearer - 1u);
                    between = uvec4(max(between.x, last), between.y, within + nearer, between.w);
                }
            }
            if (phase == CLOSING_IN) {
                if (between.y <= between.x || between.y - between.x == 1u) {
                    // Photons at one distance only: perhaps several, of which kth_tie.glsl takes the first.
                    phase = FOUND;
                    within = between.w;
                } else {
                    float low = distance_of(between.x);
                    high = distance_of(between.y);
                    float share = (float(args.wanted - between.z) - 0.5f) / float(between.w - between.z);
                    precise float even = low + (high - low) * share;
                    uint next = scans < 6u ? key_of(even) : between.x + (between.y - between.x) / 2u;
                    pivot.x = distance_of(min(max(next, between.x), between.y - 1u));
                    within = between.z;
                    below = uvec4(0u, 0u, 0u, 0u);
                    beyond = uvec4(0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu);
                }
            } else {
                below = uvec4(0u, 0u, 0u, 0u);
                beyond = below;
            }
            y = 0u;
            z = 0u;
            at = 0u;
            end = 0u;
        }
    }

    pivots = pivot;
    inner = below;
    outer = beyond;
    bracket = between;
    cursor = uvec4(y, z, at, end);
    tally = uvec4(within, visited, scans, phase);
}
