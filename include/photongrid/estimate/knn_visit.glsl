// The kNN-grid search (2.3, figure 6): visits cells in rings around the query point's cell. Until k photons are found
// the radius grows to include each new one; after that it is fixed, and further photons inside it are added. Photons
// beyond the maximum radius are rejected. The search ends when no unexplored cell lies within the radius.
//
// The result depends on the order of visits: ring by ring, within a ring z, y, x ascending, photons in map order.
// Skipping rows of cells outside the radius, and reading a row of cells as one range, keep that order.
//
// Work per pass is bounded, because drivers end long loops silently (docs/design/decisions.md). The states hold the
// result so far, which can be displayed at any time (3.4).
#include <photongrid/core/none.glsl>
#include <photongrid/estimate/growing_state.glsl>
#include <photongrid/estimate/search_tally.glsl>
#include <photongrid/map/grid.glsl>

struct Params {
    Grid grid;
    vec4 leaks;         // see photon_distance.glsl
    uint k;             // photons sought
    float max_radius2;  // m^2
    uint visits;        // the most photons to examine in a pass ...
    uint ranges;        // ... and the most rows of cells
};
PARAMS(Params)
#include <photongrid/estimate/search_inputs.glsl>
INPUT(6, vec4, powers)   // rgb, W
STATE(0, vec4, gathered) // see growing_state.glsl
STATE(1, uvec4, found)
STATE(2, uvec4, cursor)

#include <photongrid/estimate/photon_distance.glsl>

bool done()
{
    return ring_of(cursor) == NONE;
}

// The smaller of `so_far` and the gap to `cell`, if that cell exists.
float nearer(float so_far, bool exists, float u, uint c, uint cell, float size)
{
    if (!exists)
        return so_far;
    float g = gap(u, c, cell, size);
    return g < so_far ? g : so_far;
}

// The box of cells that rings 0 to `ring` around cell c cover.
struct RingBox {
    uvec4 low;
    uvec4 high;
};

RingBox box_of_rings(uvec4 c, uint ring)
{
    RingBox b;
    b.low = uvec4(c.x > ring ? c.x - ring : 0u, c.y > ring ? c.y - ring : 0u, c.z > ring ? c.z - ring : 0u, 0u);
    b.high = uvec4(min(c.x + ring, args.grid.resolution.x - 1u), min(c.y + ring, args.grid.resolution.y - 1u),
        min(c.z + ring, args.grid.resolution.z - 1u), 0u);
    return b;
}

// Whether no cell beyond the box lies within the radius. `u`: the point, in cells.
bool has_all_within(RingBox b, uvec4 c, vec3 u, float limit2)
{
    uint last_x = args.grid.resolution.x - 1u;
    uint last_y = args.grid.resolution.y - 1u;
    uint last_z = args.grid.resolution.z - 1u;
    float unexplored = 3.4028234e38f;
    unexplored = nearer(unexplored, b.high.x < last_x, u.x, c.x, b.high.x + 1u, args.grid.cell.x);
    unexplored = nearer(unexplored, b.high.y < last_y, u.y, c.y, b.high.y + 1u, args.grid.cell.y);
    unexplored = nearer(unexplored, b.high.z < last_z, u.z, c.z, b.high.z + 1u, args.grid.cell.z);
    unexplored = nearer(unexplored, b.low.x > 0u, u.x, c.x, b.low.x - 1u, args.grid.cell.x);
    unexplored = nearer(unexplored, b.low.y > 0u, u.y, c.y, b.low.y - 1u, args.grid.cell.y);
    unexplored = nearer(unexplored, b.low.z > 0u, u.z, c.z, b.low.z - 1u, args.grid.cell.z);
    bool everything = b.low.x == 0u && b.low.y == 0u && b.low.z == 0u && b.high.x == last_x
        && b.high.y == last_y && b.high.z == last_z;
    return everything || unexplored * unexplored > limit2;
}

// Where a search is among the cells of a ring.
struct RingCell {
    uint x;
    uint y;
    uint z;
    uint at; // the photons of a row, from here ...
    uint end;
};

// The next cells of a ring: the whole row (z, y) if it lies on a face of the ring's box, else its two end cells, either
// of which may lie outside the grid.
RingCell next_cells(RingCell s, RingBox b, uint ring, uvec4 c, vec3 u, float limit2)
{
    float gap_y = gap(u.y, c.y, s.y, args.grid.cell.y);
    float gap_z = gap(u.z, c.z, s.z, args.grid.cell.z);
    float row2 = gap_y * gap_y + gap_z * gap_z;
    float away2 = row2;
    bool face = s.y + ring == c.y || s.y == c.y + ring || s.z + ring == c.z || s.z == c.z + ring;
    bool lower = s.x + ring == c.x;
    uint begin_x = face || lower ? s.x : c.x + ring;
    uint end_x = face ? b.high.x : begin_x;
    s.x = !face && lower ? c.x + ring : end_x + 1u;
    if (begin_x == end_x) {
        float gap_x = gap(u.x, c.x, begin_x, args.grid.cell.x);
        away2 = away2 + gap_x * gap_x;
    }
    if (away2 <= limit2 && begin_x <= args.grid.resolution.x - 1u) {
        uint row = cell_number(args.grid, 0u, s.y, s.z);
        uvec2 first = cells(row + begin_x);
        uvec2 final = cells(row + end_x);
        s.at = first.x;
        s.end = final.x + final.y;
    }
    if (row2 > limit2)
        s.x = b.high.x + 1u; // no cell of the row lies within the radius
    if (gap_z * gap_z > limit2)
        s.y = b.high.y; // nor any row of the layer
    if (s.x > b.high.x) {
        s.x = b.low.x;
        ++s.y;
    }
    if (s.y > b.high.y) {
        s.y = b.low.y;
        ++s.z;
    }
    return s;
}

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 n = normals(i);
    uvec4 c = cell_coordinates(args.grid, p);
    vec3 u = vec3(in_cells(p.x, args.grid.origin.x, args.grid.inverse_cell.x),
        in_cells(p.y, args.grid.origin.y, args.grid.inverse_cell.y),
        in_cells(p.z, args.grid.origin.z, args.grid.inverse_cell.z));
    vec4 sum = gathered;
    float radius2 = grown_radius2(gathered);
    uint held = photons_found(found);
    uint visited = photons_visited(found);
    uint ring = ring_of(cursor);
    RingCell s;
    s.x = cell_x(cursor);
    s.y = cell_y(cursor);
    s.z = cell_z(cursor);
    s.at = next_in_row(found);
    s.end = end_of_row(found);

    uint left = args.visits;
    uint steps = args.ranges;
    // A loop over rings around a loop over rows: where lanes run in lockstep, each iteration costs as much as its most
    // expensive branch. This way the rows of neighbouring points stay in step, and the end of a ring is outside that
    // loop.
    while (steps > 0u && ring != NONE) {
        RingBox b = box_of_rings(c, ring);
        while (steps > 0u && (s.at < s.end || s.z <= b.high.z)) {
            --steps;
            // Examine the rest of the current range, within the budget.
            uint stop = s.end - s.at > left ? s.at + left : s.end;
            left -= stop - s.at;
            visited += stop - s.at;
            for (; s.at < stop; ++s.at) {
                float d2 = photon_distance2(s.at, p, n);
                if (d2 <= (held < args.k ? args.max_radius2 : radius2)) {
                    if (held < args.k && d2 > radius2)
                        radius2 = d2;
                    ++held;
                    precise vec4 more = sum + powers(s.at);
                    sum = more;
                }
            }
            if (s.at < s.end)
                steps = 0u; // budget spent
            else if (s.z <= b.high.z)
                s = next_cells(s, b, ring, c, u, held < args.k ? args.max_radius2 : radius2);
        }
        if (steps > 0u) {
            --steps;
            if (has_all_within(b, c, u, held < args.k ? args.max_radius2 : radius2)) {
                ring = NONE;
            } else {
                ++ring;
                RingBox next = box_of_rings(c, ring);
                s.x = next.low.x;
                s.y = next.low.y;
                s.z = next.low.z;
            }
        }
    }

    gathered = vec4(sum.x, sum.y, sum.z, radius2);
    found = growing_tally(held, visited, s.at, s.end);
    cursor = ring_cursor(ring, s.z, s.y, s.x);
}
