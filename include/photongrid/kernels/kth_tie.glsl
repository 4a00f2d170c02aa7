// Where several photons share the k-th distance, the first of them by id belong to the k nearest: which is the last id
// that does? Scans count the ids within four pivots, as kth_distance.glsl does with distances.
#include "grid.glsl"

struct Params {
    Grid grid;
    vec4 leaks;        // see photon_distance.glsl
    uint wanted;       // k
    uint photons;      // ids are below this
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
INPUT(6, uint, list)           // photon ids
INPUT(7, vec4, reach)          // x: squared distance of the k-th photon, m^2
STATE(0, uvec4, chosen)        // see kth_result.glsl; z: the last id, once found
STATE(1, uvec4, bracket)       // the id lies above x - 1 and is y - 1 at most; z: photons of this scan that are nearer; w: done
STATE(2, uvec4, counts)        // photons of this scan within each pivot
STATE(3, uvec4, cursor)        // y, z of the next row; next and end of the row being read

#include "photon_distance.glsl"
#include "search_rows.glsl"

bool done()
{
    return bracket.w != 0u;
}

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 n = normals(i);
    uvec4 c = cell_coordinates(args.grid, p);
    float radius2 = reach(i).x;
    uvec4 between = bracket;
    uvec4 count = counts;
    uint y = cursor.x;
    uint z = cursor.y;
    uint at = cursor.z;
    uint end = cursor.w;
    uint visited = chosen.y;
    float radius = wider(radius2);
    uvec2 rows_y = cells_within(p.y, radius, args.grid.origin.y, args.grid.inverse_cell.y, args.grid.resolution.y);
    uvec2 rows_z = cells_within(p.z, radius, args.grid.origin.z, args.grid.inverse_cell.z, args.grid.resolution.z);

    uint left = args.visits;
    uint steps = args.ranges;
    while (steps > 0u && between.w == 0u) {
        y = max(y, rows_y.x);
        z = max(z, rows_z.x);
        uint fifth = max((between.y - between.x) / 5u, 1u);
        uvec4 pivot = uvec4(between.x + fifth, between.x + 2u * fifth, between.x + 3u * fifth, between.x + 4u * fifth);
        while (steps > 0u && (at < end || z <= rows_z.y)) {
            --steps;
            uint stop = end - at > left ? at + left : end;
            left -= stop - at;
            visited += stop - at;
            for (; at < stop; ++at) {
                float d2 = photon_distance2(at, p, n);
                if (d2 < radius2)
                    ++between.z;
                if (d2 == radius2) {
                    uint key = list(at) + 1u;
                    count += uvec4(key <= pivot.x ? 1u : 0u, key <= pivot.y ? 1u : 0u, key <= pivot.z ? 1u : 0u, key <= pivot.w ? 1u : 0u);
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
        if (steps > 0u) {
            --steps;
            uint wanted = args.wanted - between.z;
            uvec2 range = uvec2(between.x, between.y);
            if (count.w >= wanted)
                range.y = min(range.y, pivot.w);
            else
                range.x = pivot.w;
            if (count.z >= wanted)
                range.y = min(range.y, pivot.z);
            else
                range.x = max(range.x, pivot.z);
            if (count.y >= wanted)
                range.y = min(range.y, pivot.y);
            else
                range.x = max(range.x, pivot.y);
            if (count.x >= wanted)
                range.y = min(range.y, pivot.x);
            else
                range.x = max(range.x, pivot.x);
            between = uvec4(range.x, range.y, 0u, range.y <= range.x + 1u ? 1u : 0u);
            count = uvec4(0u, 0u, 0u, 0u);
            y = 0u;
            z = 0u;
            at = 0u;
            end = 0u;
        }
    }

    chosen = uvec4(between.w != 0u ? args.wanted : chosen.x, visited, between.w != 0u ? between.y - 1u : chosen.z, chosen.w);
    bracket = between;
    counts = count;
    cursor = uvec4(y, z, at, end);
}
