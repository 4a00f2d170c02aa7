// Lists the indices of the photons within a point's radius, in map order, sixteen at a time: kernels have no arrays and
// write only their own element. The next part of the list continues where this one ended, so that all parts together
// scan the photons once.
#include <photongrid/estimate/list_tally.glsl>
#include <photongrid/estimate/row_cursor.glsl>
#include <photongrid/estimate/search_radius.glsl>
#include <photongrid/map/block_tree.glsl>
#include <photongrid/map/grid.glsl>

struct Params {
    Grid grid;
    vec4 leaks;        // see photon_distance.glsl
    uint visits;       // the most photons to examine in a pass ...
    uint ranges;       // ... and the most rows of cells or boxes
    uint levels;       // block map: of its tree
    uint in_blocks;    // block map: photons in blocks
};
PARAMS(Params)
#include <photongrid/estimate/search_inputs.glsl>
SWITCH(3, REPEATS) // the map may hold a photon several times
INPUT(6, uint, list)         // photon ids
INPUT(7, vec4, search_radii) // see search_radius.glsl
INPUT(8, vec4, boxes)      // block map: see block_tree.glsl
STATE(0, uvec4, first_four)  // indices of photons, the last one found first
STATE(1, uvec4, second_four)
STATE(2, uvec4, third_four)
STATE(3, uvec4, fourth_four)
STATE(4, uvec4, cursor)      // see row_cursor.glsl; y and z of a row are relative to the first one
STATE(5, uvec4, tally)       // see list_tally.glsl

#include <photongrid/estimate/photon_distance.glsl>
#include <photongrid/estimate/search_rows.glsl>
#include <photongrid/estimate/search_blocks.glsl>

bool done()
{
    return is_complete(tally) || listed_in_part(tally) == 16u;
}

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 n = normals(i);
    uvec4 c = cell_coordinates(args.grid, p);
    float radius2 = radius2_of(search_radii(i));
    float radius = wider(radius2);
    uvec2 rows_y = uvec2(0u, 0u);
    uvec2 rows_z = uvec2(0u, 0u);
    if (!BLOCKS) {
        rows_y = cells_within(p.y, radius, args.grid.origin.y, args.grid.inverse_cell.y, args.grid.resolution.y);
        rows_z = cells_within(p.z, radius, args.grid.origin.z, args.grid.inverse_cell.z, args.grid.resolution.z);
    }
    uint y = rows_y.x + row_y(cursor);
    uint z = rows_z.x + row_z(cursor);
    uvec2 place = next_node(cursor);
    uint next = first_unvisited(cursor);
    uint held = listed_in_part(tally);
    uint last_id = last_id_of(tally);
    uint last_left = last_id_count(tally);

    uint left = args.visits;
    uint steps = args.ranges;
    bool walked = BLOCKS ? has_ended(place) : z > rows_z.y;
    while (steps > 0u && held < 16u && !walked) {
        --steps;
        uvec2 row = uvec2(0u, 0u);
        bool descends = false;
        if (!BLOCKS)
            row = photons_of_row(p, y, z, c, radius2);
        else if (is_near(place.x, p, radius2)) {
            descends = !is_block(place);
            row = descends ? row : photons_of_block(place.x);
        }
        uint at = max(row.x, next);
        uint end = max(row.y, at);
        uint stop = end - at > left ? at + left : end;
        uint begun = at;
        for (; at < stop && held < 16u; ++at) {
            float d2 = photon_distance2(at, p, n);
            bool counts = d2 < radius2 || (d2 == radius2 && list(at) <= last_id);
            if (REPEATS && d2 == radius2 && list(at) == last_id) {
                counts = last_left > 0u;
                last_left -= counts ? 1u : 0u;
            }
            if (counts) {
                fourth_four = uvec4(third_four.w, fourth_four.x, fourth_four.y, fourth_four.z);
                third_four = uvec4(second_four.w, third_four.x, third_four.y, third_four.z);
                second_four = uvec4(first_four.w, second_four.x, second_four.y, second_four.z);
                first_four = uvec4(at, first_four.x, first_four.y, first_four.z);
                ++held;
            }
        }
        left -= at - begun;
        next = max(next, at);
        if (at < end) {
            steps = 0u; // out of budget, or this part is full
        } else if (BLOCKS) {
            uint level = place.y;
            place = descends ? at_children(place) : after_nodes(place, 1u);
            walked = has_ended(place);
            steps -= min(level - min(level, place.y), steps); // after_nodes() has a loop over the levels that it climbs
        } else {
            ++y;
            if (y > rows_y.y) {
                y = rows_y.x;
                ++z;
            }
            walked = z > rows_z.y;
        }
    }

    cursor = BLOCKS ? node_cursor(place, next) : row_cursor(y - rows_y.x, z - rows_z.x, next);
    tally = list_tally(held, walked, last_id, last_left);
}
