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

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 n = normals(i);
    uvec4 c = cell_coordinates(args.grid, p);
    float ux = in_cells(p.x, args.grid.origin.x, args.grid.inverse_cell.x);
    float uy = in_cells(p.y, args.grid.origin.y, args.grid.inverse_cell.y);
    float uz = in_cells(p.z, args.grid.origin.z, args.grid.inverse_cell.z);
    uint last_x = args.grid.resolution.x - 1u;
    uint last_y = args.grid.resolution.y - 1u;
    uint last_z = args.grid.resolution.z - 1u;

    vec4 sum = gathered;
    float radius2 = grown_radius2(gathered);
    uint held = photons_found(found);
    uint at = next_in_row(found);
    uint end = end_of_row(found);
    uint visited = photons_visited(found);
    uint ring = ring_of(cursor);
    uint z = cell_z(cursor);
    uint y = cell_y(cursor);
    uint x = cell_x(cursor);

    uint left = args.visits;
    uint steps = args.ranges;
    // A loop over rings around a loop over rows: where lanes run in lockstep, each iteration costs as much as its most
    // expensive branch. This way the rows of neighbouring points stay in step, and the end of a ring is outside that
    // loop.
    while (steps > 0u && ring != NONE) {
        // The box of cells that rings 0 to `ring` cover.
        uint low_x = c.x > ring ? c.x - ring : 0u;
        uint low_y = c.y > ring ? c.y - ring : 0u;
        uint low_z = c.z > ring ? c.z - ring : 0u;
        uint high_x = min(c.x + ring, last_x);
        uint high_y = min(c.y + ring, last_y);
        uint high_z = min(c.z + ring, last_z);

        while (steps > 0u && (at < end || z <= high_z)) {
            --steps;
            // Examine the rest of the current range, within the budget.
            uint stop = end - at > left ? at + left : end;
            left -= stop - at;
            visited += stop - at;
            for (; at < stop; ++at) {
                float d2 = photon_distance2(at, p, n);
                if (d2 <= (held < args.k ? args.max_radius2 : radius2)) {
                    if (held < args.k && d2 > radius2)
                        radius2 = d2;
                    ++held;
                    precise vec4 more = sum + powers(at);
                    sum = more;
                }
            }
            if (at < end) {
                steps = 0u; // budget spent
            } else if (z <= high_z) {
                // The next cells of this ring: the whole row (z, y) if it lies on a face of the ring's box, else its
                // two end cells, either of which may lie outside the grid.
                float limit2 = held < args.k ? args.max_radius2 : radius2;
                float gap_y = gap(uy, c.y, y, args.grid.cell.y);
                float gap_z = gap(uz, c.z, z, args.grid.cell.z);
                float row2 = gap_y * gap_y + gap_z * gap_z;
                float away2 = row2;
                bool face = y + ring == c.y || y == c.y + ring || z + ring == c.z || z == c.z + ring;
                bool lower = x + ring == c.x;
                uint begin_x = face || lower ? x : c.x + ring;
                uint end_x = face ? high_x : begin_x;
                x = !face && lower ? c.x + ring : end_x + 1u;
                if (begin_x == end_x) {
                    float gap_x = gap(ux, c.x, begin_x, args.grid.cell.x);
                    away2 = away2 + gap_x * gap_x;
                }
                if (away2 <= limit2 && begin_x <= last_x) {
                    uint row = cell_number(args.grid, 0u, y, z);
                    uvec2 first = cells(row + begin_x);
                    uvec2 final = cells(row + end_x);
                    at = first.x;
                    end = final.x + final.y;
                }
                if (row2 > limit2)
                    x = high_x + 1u; // no cell of the row lies within the radius
                if (gap_z * gap_z > limit2)
                    y = high_y; // nor any row of the layer
                if (x > high_x) {
                    x = low_x;
                    ++y;
                }
                if (y > high_y) {
                    y = low_y;
                    ++z;
                }
            }
        }

        if (steps > 0u) {
            // The ring is explored. Does any cell beyond it lie within the radius?
            --steps;
            float limit2 = held < args.k ? args.max_radius2 : radius2;
            float unexplored = 3.4028234e38f;
            unexplored = nearer(unexplored, high_x < last_x, ux, c.x, high_x + 1u, args.grid.cell.x);
            unexplored = nearer(unexplored, high_y < last_y, uy, c.y, high_y + 1u, args.grid.cell.y);
            unexplored = nearer(unexplored, high_z < last_z, uz, c.z, high_z + 1u, args.grid.cell.z);
            unexplored = nearer(unexplored, low_x > 0u, ux, c.x, low_x - 1u, args.grid.cell.x);
            unexplored = nearer(unexplored, low_y > 0u, uy, c.y, low_y - 1u, args.grid.cell.y);
            unexplored = nearer(unexplored, low_z > 0u, uz, c.z, low_z - 1u, args.grid.cell.z);
            bool everything = low_x == 0u && low_y == 0u && low_z == 0u && high_x == last_x && high_y == last_y
                && high_z == last_z;
            if (everything || unexplored * unexplored > limit2) {
                ring = NONE;
            } else {
                ++ring;
                z = c.z > ring ? c.z - ring : 0u;
                y = c.y > ring ? c.y - ring : 0u;
                x = c.x > ring ? c.x - ring : 0u;
            }
        }
    }

    gathered = vec4(sum.x, sum.y, sum.z, radius2);
    found = growing_tally(held, visited, at, end);
    cursor = ring_cursor(ring, z, y, x);
}
