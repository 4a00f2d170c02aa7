// If several photons have the k-th distance, those with the smallest ids belong to the k nearest. This kernel finds the
// last such id: scans count the ids up to four pivots, as kth_distance.glsl counts distances. The kernel is one
// function, because it is one state machine over local copies of the states.
#include <photongrid/backend/none.glsl>
#include <photongrid/map/grid.glsl>

struct Params {
    Grid grid;
    vec4 leaks;        // see photon_distance.glsl
    uint k;            // photons sought
    uint photons;      // ids are below this
    uint visits;       // the most photons to examine in a pass ...
    uint ranges;       // ... and the most rows of cells
};
PARAMS(Params)
#include <photongrid/estimate/search_inputs.glsl>
IN_GROUPS(3)
INPUT(6, uint, list)         // photon ids
INPUT(7, vec4, search_radii) // x: squared distance of the k-th photon, m^2
STATE(0, uvec4, chosen)      // see kth_result.glsl; z: the last id, once found
STATE(1, uvec4, bracket)     // x - 1 < id <= y - 1; z: photons of this scan that are nearer than the radius; w: done
STATE(2, uvec4, counts)      // photons of this scan within each pivot
STATE(3, uvec4, cursor)      // y, z of the next row; the first photon not yet visited

#include <photongrid/estimate/photon_distance.glsl>
#include <photongrid/estimate/search_rows.glsl>
#include <photongrid/estimate/photon_walk.glsl>

uint chunk_id;
void gather_ids(uint nth, uint all)
{
    gather_chunk(nth, all);
    chunk_id = list(chunk_index);
}

bool done()
{
    return bracket.w != 0u;
}

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 n = normals(i);
    uvec4 c = cell_coordinates(args.grid, p);
    float radius2 = search_radii(i).x;
    uvec4 between = bracket;
    uvec4 count = counts;
    uvec4 resume_at = cursor;
    uint visited = chosen.y;

    walk_visits = args.visits;
    walk_steps = args.ranges;
    while (walk_steps > 0u && group_any(between.w == 0u)) {
        uint fifth = max((between.y - between.x) / 5u, 1u);
        uvec4 pivot = uvec4(between.x + fifth, between.x + 2u * fifth, between.x + 3u * fifth, between.x + 4u * fifth);
        bool mine = joins_walk(between.w == 0u, p, c, radius2, resume_at);
        vec4 from = vec4(mine ? p.x : -3.0e38f, p.y, p.z, 0.0f); // the other lanes count nothing
        while (walks_on()) {
            uint photons = next_rows();
            visited += mine ? photons : 0u;
#define VISIT(LANE)                                                           \
    {                                                                         \
        float d2 = distance2_of(PHOTON_OF(LANE), from, n);                    \
        between.z += d2 < radius2 ? 1u : 0u;                                  \
        uint id = from_lane(chunk_id, LANE);                                  \
        uint key = d2 == radius2 ? id + 1u : NONE;                            \
        count += uvec4(key <= pivot.x ? 1u : 0u, key <= pivot.y ? 1u : 0u,    \
            key <= pivot.z ? 1u : 0u, key <= pivot.w ? 1u : 0u);              \
    }
            if (photons > 0u)
                EACH_PHOTON(photons, gather_ids, VISIT)
#undef VISIT
        }
        if (mine)
            resume_at = uvec4(walk.x, walk.y, walk.z, 0u);
        if (mine && has_walked()) {
            uint missing = args.k - between.z;
            uvec2 range = uvec2(between.x, between.y);
            if (count.w >= missing)
                range.y = min(range.y, pivot.w);
            else
                range.x = pivot.w;
            if (count.z >= missing)
                range.y = min(range.y, pivot.z);
            else
                range.x = max(range.x, pivot.z);
            if (count.y >= missing)
                range.y = min(range.y, pivot.y);
            else
                range.x = max(range.x, pivot.y);
            if (count.x >= missing)
                range.y = min(range.y, pivot.x);
            else
                range.x = max(range.x, pivot.x);
            between = uvec4(range.x, range.y, 0u, range.y <= range.x + 1u ? 1u : 0u);
            count = uvec4(0u, 0u, 0u, 0u);
            resume_at = uvec4(0u, 0u, 0u, 0u);
        }
    }

    chosen = uvec4(between.w != 0u ? args.k : chosen.x, visited, between.w != 0u ? between.y - 1u : chosen.z, chosen.w);
    bracket = between;
    counts = count;
    cursor = resume_at;
}
