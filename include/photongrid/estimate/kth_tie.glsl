// If several photons have the k-th distance, those with the smallest ids belong to the k nearest. This kernel finds the
// last such id, and how often it counts, since a routed map may hold a photon several times. The first scan finds the
// smallest and the largest id at the radius, which are the same if one photon is repeated. Further scans count the ids
// below each of four pivots between them, as kth_distance.glsl counts distances. The kernel is one function, because it
// is one state machine over local copies of the states.
#include <photongrid/backend/none.glsl>
#include <photongrid/map/grid.glsl>
#include <photongrid/estimate/tie_phases.glsl>

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
STATE(0, uvec4, chosen)      // see kth_result.glsl; z: the last id, once found; w: until then, how many ids at the
                             // radius are below bracket.x
STATE(1, uvec4, bracket)     // x <= id < y; z: photons of this scan that are nearer than the radius; w: phase
STATE(2, uvec4, counts)      // FIRST_AND_LAST: NONE - smallest id, largest id + 1; COUNTING_IDS: ids below each pivot
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
    return bracket.w == FOUND_ID;
}

// The bracket x, y, with z ids at the radius below x, narrowed by the number of ids below a pivot.
uvec4 narrowed(uvec4 range, uint pivot, uint below, uint missing)
{
    if (below >= missing)
        return uvec4(range.x, min(range.y, pivot), range.z, 0u);
    return pivot > range.x ? uvec4(pivot, range.y, below, 0u) : range;
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
    uvec4 result = chosen;

    walk_visits = args.visits;
    walk_steps = args.ranges;
    while (walk_steps > 0u && group_any(between.w != FOUND_ID)) {
        uint fifth = max((between.y - between.x) / 5u, 1u);
        uvec4 pivot = uvec4(between.x + fifth, between.x + 2u * fifth, between.x + 3u * fifth, between.x + 4u * fifth);
        bool mine = joins_walk(
            between.w != FOUND_ID, p, c, radius2, uvec4(resume_at.x, resume_at.y, resume_at.z, between.w));
        vec4 from = vec4(mine ? p.x : -3.0e38f, p.y, p.z, 0.0f); // the other lanes count nothing
        while (walks_on()) {
            uint photons = next_rows();
            result.y += mine ? photons : 0u;
#define VISIT(LANE)                                                           \
    {                                                                         \
        float d2 = distance2_of(PHOTON_OF(LANE), from, n);                    \
        between.z += d2 < radius2 ? 1u : 0u;                                  \
        uint id = from_lane(chunk_id, LANE);                                  \
        uint key = d2 == radius2 ? id : NONE;                                 \
        if (walk_phase() == FIRST_AND_LAST)                                   \
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
            resume_at = uvec4(walk.x, walk.y, walk.z, 0u);
        if (mine && has_walked()) {
            uint missing = args.k - between.z;
            uvec4 range = uvec4(NONE - count.x, count.y, 0u, 0u);
            if (between.w == COUNTING_IDS) {
                range = uvec4(between.x, between.y, result.w, 0u);
                range = narrowed(range, pivot.x, count.x, missing);
                range = narrowed(range, pivot.y, count.y, missing);
                range = narrowed(range, pivot.z, count.z, missing);
                range = narrowed(range, pivot.w, count.w, missing);
            }
            bool one = range.y <= range.x || range.y - range.x == 1u;
            between = uvec4(range.x, range.y, 0u, one ? FOUND_ID : COUNTING_IDS);
            result = one ? uvec4(args.k, result.y, range.x, missing - range.z)
                         : uvec4(result.x, result.y, result.z, range.z);
            count = uvec4(0u, 0u, 0u, 0u);
            resume_at = uvec4(0u, 0u, 0u, 0u);
        }
    }

    chosen = result;
    bracket = between;
    counts = count;
    cursor = resume_at;
}
