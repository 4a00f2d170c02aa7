// Adds up the photons that a search chose, weighted by a kernel of their distance that falls from 1 to 0 (2.3; filters:
// Jensen 2001, section 7.3; Silverman 1986). Sums are compensated (Kahan), so that ten thousand photons lose no more than ten.
//
// LEAVE_OUT takes the photon that sets the radius out of the sum: N photons within their largest distance are N - 1 within
// a disc of that size, and any weights have the right mean (Garcia Hernandez et al. 2012; docs/decisions.md).
#include "grid.glsl"

struct Params {
    Grid grid;
    vec4 leaks;        // see photon_distance.glsl
    float min_radius2; // m^2; the disc is never smaller
    uint visits;       // photons examined in a pass at most ...
    uint ranges;       // ... in this many rows of cells at most
};
PARAMS(Params)
SWITCH(0, SIDE)
SWITCH(1, NORMALS)
SWITCH(2, FLATTEN)
SWITCH(3, CONE)         // weight 1 - d / r
SWITCH(4, EPANECHNIKOV) // 1 - d^2 / r^2
SWITCH(5, SILVERMAN)    // (1 - d^2 / r^2)^2; none of the three: 1
SWITCH(6, LEAVE_OUT)
SWITCH(7, ERRORS)       // squares are wanted
INPUT(0, vec4, points)         // xyz: query point, m
INPUT(1, vec4, normals)        // xyz: unit normal of the surface there
INPUT(2, uvec2, cells)         // x: first photon, y: count
INPUT(3, vec4, positions)      // xyz, m, cell by cell
INPUT(4, vec4, directions)
INPUT(5, vec4, photon_normals)
INPUT(6, uint, list)           // photon ids
INPUT(7, vec4, powers)         // rgb, W
STATE(0, vec4, reach)          // see kth_result.glsl
STATE(1, uvec4, chosen)
STATE(2, vec4, sum)            // rgb: weighted flux, W
STATE(3, vec4, lost)           // rgb: what rounding took from it
STATE(4, vec4, squares)        // rgb: squares of the weighted fluxes; w: of their sums over channels
STATE(5, uvec4, cursor)        // y, z of the next row; next and end of the row being read
STATE(6, uvec4, tally)         // photons held, photons visited, place + 1 of the one left out, done

#include "photon_distance.glsl"
#include "search_rows.glsl"

bool done()
{
    return tally.w != 0u;
}

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 n = normals(i);
    uvec4 c = cell_coordinates(args.grid, p);
    float radius2 = reach.x;
    bool apart = LEAVE_OUT && reach.y > 0.0f && radius2 >= args.min_radius2;
    float inverse_disc2 = 1.0f / max(radius2, args.min_radius2);
    uint last_id = chosen.z;
    vec4 total = sum;
    vec4 rest = lost;
    vec4 square = squares;
    uint y = cursor.x;
    uint z = cursor.y;
    uint at = cursor.z;
    uint end = cursor.w;
    uint held = tally.x;
    uint visited = tally.y;
    uint left_out = tally.z;
    float radius = wider(radius2);
    uvec2 rows_y = cells_within(p.y, radius, args.grid.origin.y, args.grid.inverse_cell.y, args.grid.resolution.y);
    uvec2 rows_z = cells_within(p.z, radius, args.grid.origin.z, args.grid.inverse_cell.z, args.grid.resolution.z);
    y = max(y, rows_y.x);
    z = max(z, rows_z.x);

    uint left = args.visits;
    uint steps = args.ranges;
    while (steps > 0u && (at < end || z <= rows_z.y)) {
        --steps;
        uint stop = end - at > left ? at + left : end;
        left -= stop - at;
        visited += stop - at;
        for (; at < stop; ++at) {
            float d2 = photon_distance2(at, p, n);
            if (d2 < radius2 || (d2 == radius2 && list(at) <= last_id)) {
                ++held;
                // Of several photons at the radius itself, the one with the largest id is left out.
                uint adding = at + 1u;
                if (apart && d2 == radius2) {
                    adding = left_out;
                    left_out = at + 1u;
                    if (adding != 0u && list(adding - 1u) > list(at)) {
                        left_out = adding;
                        adding = at + 1u;
                    }
                }
                if (adding != 0u) {
                    float weight = 1.0f;
                    float t = d2 * inverse_disc2;
                    t = t < 1.0f ? t : 1.0f;
                    if (CONE)
                        weight = 1.0f - sqrt(t);
                    if (EPANECHNIKOV)
                        weight = 1.0f - t;
                    if (SILVERMAN)
                        weight = (1.0f - t) * (1.0f - t);
                    precise vec4 flux = powers(adding - 1u) * weight;
                    precise vec4 term = flux - rest;
                    precise vec4 more = total + term;
                    precise vec4 error = (more - total) - term;
                    total = more;
                    rest = error;
                    if (ERRORS) {
                        float all = flux.x + flux.y + flux.z;
                        square += vec4(flux.x * flux.x, flux.y * flux.y, flux.z * flux.z, all * all);
                    }
                }
            }
        }
        if (at < end) {
            steps = 0u; // budget spent
        } else if (z <= rows_z.y) {
            uvec2 row = photons_of_row(p, y, z, c, radius2);
            at = row.x;
            end = row.y;
            ++y;
            if (y > rows_y.y) {
                y = rows_y.x;
                ++z;
            }
        }
    }

    sum = total;
    lost = rest;
    squares = square;
    cursor = uvec4(y, z, at, end);
    tally = uvec4(held, visited, left_out, at < end || z <= rows_z.y ? 0u : 1u);
}
