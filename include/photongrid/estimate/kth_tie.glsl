// If several photons have the k-th distance, those with the smallest ids belong to the k nearest. This kernel finds the
// last such id, and how often it counts, since a routed map may hold a photon several times. The first scan finds the
// smallest and the largest id at the radius, which are the same if one photon is repeated. Further scans count the ids
// below each of four pivots between them, as kth_distance.glsl counts distances.
#include <photongrid/core/none.glsl>
#include <photongrid/map/block_tree.glsl>
#include <photongrid/map/grid.glsl>
#include <photongrid/estimate/row_cursor.glsl>
#include <photongrid/estimate/search_radius.glsl>
#include <photongrid/estimate/search_tally.glsl>
#include <photongrid/estimate/tie_state.glsl>

struct Params {
    Grid grid;
    vec4 leaks;        // see photon_distance.glsl
    uint k;            // photons sought
    uint photons;      // ids are below this
    uint visits;       // the most photons to examine in a pass ...
    uint ranges;       // ... and the most rows of cells or boxes
    uint levels;       // block map: of its tree
    uint in_blocks;    // block map: photons in blocks
};
PARAMS(Params)
#include <photongrid/estimate/search_inputs.glsl>
IN_GROUPS(3)
INPUT(6, uint, list)         // photon ids
INPUT(7, vec4, search_radii) // see search_radius.glsl
INPUT(8, vec4, boxes)      // block map: see block_tree.glsl
STATE(0, uvec4, chosen)      // the same; until the last id is found, w counts the ids at the radius below the bracket
STATE(1, uvec4, bracket)     // see tie_state.glsl
STATE(2, uvec4, counts)      // FIRST_AND_LAST: NONE - smallest id, largest id + 1; COUNTING_IDS: ids below each pivot
STATE(3, uvec4, cursor)      // see row_cursor.glsl

#include <photongrid/estimate/photon_distance.glsl>
#include <photongrid/estimate/search_rows.glsl>
#include <photongrid/estimate/search_blocks.glsl>
#include <photongrid/estimate/photon_walk.glsl>

LANE_VARIABLE(uint, chunk_id)
void gather_ids(uint nth, uint all)
{
    gather_chunk(nth, all);
    set_lane(chunk_id, list(chunk_index));
}

bool done()
{
    return tie_phase(bracket) == FOUND_ID;
}

// A bracket x <= id < y, where z ids at the radius are below x, narrowed by the number of ids below a pivot. Of the ids
// at the radius, the last that counts is number `missing`.
uint ids_below(uvec4 range)
{
    return range.z;
}
uvec4 narrowed(uvec4 range, uint pivot, uint below, uint missing)
{
    uint first = first_id(range);
    uint past = past_id(range);
    if (below >= missing)
        return uvec4(first, min(past, pivot), ids_below(range), 0u);
    return pivot > first ? uvec4(pivot, past, below, 0u) : range;
}

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 n = normals(i);
    uvec4 c = cell_coordinates(args.grid, p);
    float radius2 = radius2_of(search_radii(i));
    uint first = first_id(bracket);
    uint past = past_id(bracket);
    uint nearer = photons_nearer(bracket);
    uint phase = tie_phase(bracket);
    uvec4 count = counts;
    uvec4 resume_at = cursor;
    uint found = photons_found(chosen);
    uint visited = photons_visited(chosen);
    uint last_id = last_id_of(chosen);
    uint last_count = last_id_count(chosen); // until the id is found: the ids at the radius below `first`

    walk_visits = args.visits;
    walk_steps = args.ranges;
    while (walk_steps > 0u && group_any(phase != FOUND_ID)) {
        uint fifth = max((past - first) / 5u, 1u);
        uvec4 pivot = uvec4(first + fifth, first + 2u * fifth, first + 3u * fifth, first + 4u * fifth);
        bool mine = joins_walk(phase != FOUND_ID, p, c, radius2, in_phase(resume_at, phase));
        vec4 from = vec4(mine ? p.x : -3.0e38f, p.y, p.z, 0.0f); // the other lanes count nothing
        while (walks_on()) {
            uint photons = next_rows();
            visited += mine ? photons : 0u;
#define VISIT(LANE)                                                           \
    {                                                                         \
        float d2 = distance2_of(PHOTON_OF(LANE), from, n);                    \
        nearer += d2 < radius2 ? 1u : 0u;                                     \
        uint id = from_lane(chunk_id, LANE);                                  \
        uint key = d2 == radius2 ? id : NONE;                                 \
        if (walk_phase == FIRST_AND_LAST)                                     \
            count = max(count, uvec4(NONE - key, key + 1u, 0u, 0u));          \
        else                                                                  \
            count += uvec4(key < pivot.x ? 1u : 0u, key < pivot.y ? 1u : 0u,  \
                key < pivot.z ? 1u : 0u, key < pivot.w ? 1u : 0u);            \
    }
            if (photons > 0u)
                EACH_PHOTON(photons, gather_ids, VISIT)
#undef VISIT
        }
        if (mine)
            resume_at = walk_cursor();
        if (mine && has_walked()) {
            uint missing = args.k - nearer;
            uvec4 range = uvec4(NONE - count.x, count.y, 0u, 0u);
            if (phase == COUNTING_IDS) {
                range = uvec4(first, past, last_count, 0u);
                range = narrowed(range, pivot.x, count.x, missing);
                range = narrowed(range, pivot.y, count.y, missing);
                range = narrowed(range, pivot.z, count.z, missing);
                range = narrowed(range, pivot.w, count.w, missing);
            }
            first = first_id(range);
            past = past_id(range);
            nearer = 0u;
            bool one = past <= first || past - first == 1u;
            phase = one ? FOUND_ID : COUNTING_IDS;
            found = one ? args.k : found;
            last_id = one ? first : last_id;
            last_count = one ? missing - ids_below(range) : ids_below(range);
            count = uvec4(0u, 0u, 0u, 0u);
            resume_at = at_first_row();
        }
    }

    chosen = chosen_of(found, visited, last_id, last_count);
    bracket = id_bracket(first, past, nearer, phase);
    counts = count;
    cursor = resume_at;
}
