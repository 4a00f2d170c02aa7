// The squared distance of the k-th nearest photon, without an array of k: scans of the photons within a radius count how
// many lie within each of four pivots; the counts narrow a bracket about the k-th, and new pivots are laid into it by
// interpolation. Once the k-th is one of the four farthest in the bracket, or of the three nearest, a last scan keeps these
// in order. That makes three scans where photons are spread evenly over a small disc; where they are not, after a few scans
// pivots halve the bracket's bits, and at most some twenty end it.
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
STATE(0, vec4, pivots)   // squared distances, ascending; a scan goes as far as w
STATE(1, uvec4, counts)  // photons of this scan within each pivot
STATE(2, vec4, extremes) // last scan: the bracket's four farthest, descending, or the negatives of its four nearest
STATE(3, uvec4, bracket) // the k-th key lies above x and is y at most; z and w photons lie within x and y, w: 0xFFFFFFFF: unknown
STATE(4, uvec4, cursor)  // y, z of the next row; next and end of the row being read
STATE(5, uvec4, tally)   // photons within y, more than k where several share the k-th distance; photons visited; scans; phase

#include "photon_distance.glsl"
#include "search_rows.glsl"

// Phases
const uint COUNTING = 0u;
const uint FARTHEST = 1u; // the last scan, by the farthest of the bracket ...
const uint NEAREST = 2u;  // ... or by its nearest
const uint FOUND = 3u;

bool done()
{
    return tally.w == FOUND;
}

// The n-th component, from 0.
float component(vec4 v, uint n)
{
    return n == 0u ? v.x : n == 1u ? v.y : n == 2u ? v.z : v.w;
}

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 n = normals(i);
    uvec4 c = cell_coordinates(args.grid, p);
    vec4 pivot = pivots;
    uvec4 count = counts;
    vec4 extreme = extremes;
    uvec4 between = bracket;
    uint y = cursor.x;
    uint z = cursor.y;
    uint at = cursor.z;
    uint end = cursor.w;
    uint found = tally.x;
    uint visited = tally.y;
    uint scans = tally.z;
    uint phase = tally.w;

    uint left = args.visits;
    uint steps = args.ranges;
    while (steps > 0u && phase != FOUND) {
        float low = distance_of(between.x);
        float high = distance_of(between.y);
        float scan2 = phase == COUNTING ? pivot.w : high;
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
                    count.x += d2 <= pivot.x ? 1u : 0u;
                    count.y += d2 <= pivot.y ? 1u : 0u;
                    count.z += d2 <= pivot.z ? 1u : 0u;
                    count.w += d2 <= pivot.w ? 1u : 0u;
                }
            } else {
                for (; at < stop; ++at) {
                    float d2 = photon_distance2(at, p, n);
                    if (d2 <= high && key_of(d2) > between.x) {
                        float e = phase == FARTHEST ? d2 : -d2;
                        extreme.w = max(extreme.w, min(extreme.z, e));
                        extreme.z = max(extreme.z, min(extreme.y, e));
                        extreme.y = max(extreme.y, min(extreme.x, e));
                        extreme.x = max(extreme.x, e);
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
                uvec4 few = uvec4(count.x < args.wanted ? 1u : 0u, count.y < args.wanted ? 1u : 0u, count.z < args.wanted ? 1u : 0u, count.w < args.wanted ? 1u : 0u);
                if (few.x + few.y + few.z + few.w > 0u) {
                    float below = few.w != 0u ? pivot.w : few.z != 0u ? pivot.z : few.y != 0u ? pivot.y : pivot.x;
                    uint within = few.w != 0u ? count.w : few.z != 0u ? count.z : few.y != 0u ? count.y : count.x;
                    if (key_of(below) > between.x)
                        between = uvec4(key_of(below), between.y, within, between.w);
                }
                if (few.w == 0u) {
                    float above = few.x == 0u ? pivot.x : few.y == 0u ? pivot.y : few.z == 0u ? pivot.z : pivot.w;
                    uint within = few.x == 0u ? count.x : few.y == 0u ? count.y : few.z == 0u ? count.z : count.w;
                    if (between.w == 0xFFFFFFFFu || key_of(above) < between.y)
                        between = uvec4(between.x, key_of(above), between.z, within);
                }
                low = distance_of(between.x);
                high = distance_of(between.y);
                if (between.w == 0xFFFFFFFFu) {
                    // Fewer than k so far. Wider, unless that was the widest: then these are all.
                    phase = pivot.w >= args.max_radius2 ? FOUND : COUNTING;
                    found = count.w;
                    scans = 0u;
                    precise float growth = 1.1f * (float(args.wanted) / float(max(count.w, 1u)));
                    precise float more = pivot.w * (min(growth, 16.0f) - 1.0f);
                    precise vec4 next = vec4(pivot.w + 0.5f * more, pivot.w + 0.8f * more, pivot.w + more, pivot.w + 1.5f * more);
                    pivot = vec4(min(next.x, args.max_radius2), min(next.y, args.max_radius2), min(next.z, args.max_radius2), min(next.w, args.max_radius2));
                } else if (between.y <= between.x + 1u) {
                    // Photons at one distance only: perhaps several, of which kth_tie.glsl takes the first.
                    phase = FOUND;
                    found = between.w;
                } else if (between.w - args.wanted < 4u) {
                    phase = FARTHEST;
                } else if (args.wanted - between.z < 4u) {
                    phase = NEAREST;
                } else if (scans < 6u) {
                    // Where the k-th is if photons are spread evenly between low and high, and how far off that may be:
                    // pivots seven photons apart, or one half of the standard deviation of so many.
                    float inside = float(between.w - between.z);
                    precise float one = (high - low) / inside;
                    precise float middle = low + one * (float(args.wanted - between.z) - 0.5f);
                    precise float off = one * max(3.5f, 0.25f * sqrt(inside));
                    precise vec4 next = vec4(middle - 3.0f * off, middle - off, middle + off, middle + 3.0f * off);
                    pivot = vec4(max(next.x, low), max(next.y, low), min(next.z, high), min(next.w, high));
                } else {
                    uint fifth = max((between.y - between.x) / 5u, 1u);
                    pivot = vec4(distance_of(between.x + fifth), distance_of(min(between.x + fifth * 2u, between.y)), distance_of(min(between.x + fifth * 3u, between.y)),
                        distance_of(min(between.x + fifth * 4u, between.y)));
                }
                extreme = vec4(-3.4028234e38f, -3.4028234e38f, -3.4028234e38f, -3.4028234e38f);
            } else {
                // How many of the bracket come before the k-th in this order; its neighbour on the far side tells of a tie.
                uint before = phase == FARTHEST ? between.w - args.wanted : args.wanted - between.z - 1u;
                float kth = component(extreme, before);
                bool tie = phase == FARTHEST ? before > 0u && component(extreme, before - 1u) == kth : component(extreme, before + 1u) == kth;
                between.y = key_of(abs(kth));
                found = args.wanted + (tie ? 1u : 0u);
                phase = FOUND;
            }
            count = uvec4(0u, 0u, 0u, 0u);
            y = 0u;
            z = 0u;
            at = 0u;
            end = 0u;
        }
    }

    pivots = pivot;
    counts = count;
    extremes = extreme;
    bracket = between;
    cursor = uvec4(y, z, at, end);
    tally = uvec4(found, visited, scans, phase);
}
