// Sums the power of the photons that a search found, weighted by a filter of their distance that falls from 1 to 0
// (2.3, filter.glsl). Sums are compensated (Kahan), so that the rounding error does not grow with the number of
// photons.
//
// LEAVE_OUT excludes the photon that sets the radius: of N photons, N - 1 lie inside the disc whose radius is the
// largest distance, and with those the mean of the estimate is right for every filter (Garcia Hernandez et al. 2012;
// docs/design/decisions.md).
//
// Where the map holds a photon s times, each entry has 1 / s of its power. The photon appears as s fully correlated
// entries, so its variance is s times the sum of their squares.
#include <photongrid/core/vector.glsl>
#include <photongrid/estimate/gather_tally.glsl>
#include <photongrid/estimate/half_space.glsl>
#include <photongrid/estimate/row_cursor.glsl>
#include <photongrid/estimate/search_radius.glsl>
#include <photongrid/estimate/search_tally.glsl>
#include <photongrid/map/block_tree.glsl>
#include <photongrid/map/grid.glsl>

struct Params {
    Grid grid;
    vec4 leaks;        // see photon_distance.glsl
    float min_radius2; // m^2; see least_disc2
    uint visits;       // the most photons to examine in a pass ...
    uint ranges;       // ... and the most rows of cells or boxes
    uint levels;       // block map: of its tree
    uint in_blocks;    // block map: photons in blocks
};
PARAMS(Params)
#include <photongrid/estimate/search_inputs.glsl>
SWITCH(10, HALVED) // points may have half spaces
#include <photongrid/estimate/filter.glsl>
SWITCH(3, LEAVE_OUT)
SWITCH(4, ERRORS) // compute the squares too
SWITCH(5, REPEATS) // the map may hold a photon several times
IN_GROUPS(8)
INPUT(6, uint, list)          // photon ids
INPUT(7, vec4, powers)        // rgb, W; w: REPEATS: how often the map holds the photon
INPUT(8, vec4, boxes)      // block map: see block_tree.glsl
STATE(0, vec4, search_radius) // see search_radius.glsl
STATE(1, uvec4, chosen)       // the same; w: how often the last id still counts
STATE(2, vec4, sum)           // rgb: weighted power, W
STATE(3, vec4, compensation)  // rgb: rounding error of the sum so far (Kahan)
STATE(4, vec4, squares)       // rgb: squares of the weighted powers; w: of their sums over channels
STATE(5, uvec4, cursor)       // see row_cursor.glsl
STATE(6, uvec4, tally)        // see gather_tally.glsl

#include <photongrid/estimate/photon_distance.glsl>
#include <photongrid/estimate/search_rows.glsl>
#include <photongrid/estimate/search_blocks.glsl>
#include <photongrid/estimate/photon_walk.glsl>

LANE_VARIABLE(uint, chunk_place)
LANE_VARIABLE(uint, chunk_id)
LANE_VARIABLE(vec4, chunk_power)
void gather_powers(uint nth, uint all)
{
    gather_chunk(nth, all);
    set_lane(chunk_place, chunk_index);
    set_lane(chunk_id, list(chunk_index));
    set_lane(chunk_power, powers(chunk_index));
}

// The filter's weight at a squared share of the radius.
float weight_at(float t)
{
    return filter_weight(t < 1.0f ? t : 1.0f);
}

// What a weighted photon adds to `squares`. `stands_for`: how many photons it is.
vec4 squares_of(vec4 weighted, float stands_for)
{
    float all = weighted.x + weighted.y + weighted.z;
    vec4 weighted2
        = vec4(weighted.x * weighted.x, weighted.y * weighted.y, weighted.z * weighted.z, all * all);
    if (REPEATS)
        weighted2 = weighted2 * stands_for;
    return weighted2;
}

bool done()
{
    return is_gathered(tally);
}

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 n = normals(i);
    uvec4 c = cell_coordinates(args.grid, p);
    float radius2 = radius2_of(search_radius);
    float least2 = least_disc2(p, args.min_radius2);
    bool excludes = LEAVE_OUT && excludes_photon(search_radius, least2);
    float inverse_disc2 = 1.0f / max(radius2, least2);
    uint last_id = last_id_of(chosen);
    uint last_left = last_id_count(chosen);
    vec4 total = sum;
    vec4 correction = compensation;
    uint held = photons_found(tally);
    uint visited = photons_visited(tally);
    uint past_excluded = past_excluded_of(tally);
    uint excluded_id = 0u;
    vec4 excluded_power = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (past_excluded != 0u) {
        excluded_id = list(past_excluded - 1u);
        excluded_power = powers(past_excluded - 1u);
    }
    bool finished = is_gathered(tally);
    HalfSpace before = half_space_of(vec4(n.x, n.y, n.z, HALVED ? n.w : 0.0f), sqrt(p.w));

    walk_visits = args.visits;
    walk_steps = args.ranges;
    while (walk_steps > 0u && group_any(!finished)) {
        bool mine = joins_walk(!finished, p, c, radius2, cursor);
        vec4 from = vec4(mine ? p.x : -3.0e38f, p.y, p.z, 0.0f); // the other lanes find nothing
        while (walks_on()) {
            uint photons = next_rows();
            visited += mine ? photons : 0u;
            // If several photons lie at the radius, the one with the largest id is excluded.
#define VISIT(LANE)                                                                        \
    {                                                                                      \
        float d2 = distance2_of(PHOTON_OF(LANE), from, n);                                 \
        if (HALVED) {                                                                      \
            vec4 q = from_lane(chunk_position, LANE);                                      \
            d2 = is_beyond(before, q.x - p.x, q.y - p.y, q.z - p.z) ? 3.4028234e38f : d2;  \
        }                                                                                  \
        if (GROUP_LANES > 1u || d2 <= radius2) {                                           \
            uint at = from_lane(chunk_place, LANE);                                        \
            uint id = from_lane(chunk_id, LANE);                                           \
            vec4 power = from_lane(chunk_power, LANE);                                     \
            bool at_radius = d2 == radius2 && id <= last_id;                               \
            if (REPEATS) {                                                                 \
                bool is_last = at_radius && id == last_id;                                 \
                at_radius = at_radius && !(is_last && last_left == 0u);                    \
                last_left -= is_last && last_left > 0u ? 1u : 0u;                          \
            }                                                                              \
            bool counts = d2 < radius2 || at_radius;                                       \
            held += counts ? 1u : 0u;                                                      \
            bool is_first = past_excluded == 0u;                                           \
            bool swaps = excludes && at_radius && (is_first || id > excluded_id);          \
            counts = counts && !(swaps && is_first);                                       \
            vec4 added = swaps ? excluded_power : power;                                   \
            past_excluded = swaps ? at + 1u : past_excluded;                               \
            excluded_id = swaps ? id : excluded_id;                                        \
            excluded_power = swaps ? power : excluded_power;                               \
            precise vec4 weighted = added * weight_at(d2 * inverse_disc2);                 \
            precise vec4 term = weighted - correction;                                     \
            precise vec4 more = total + term;                                              \
            precise vec4 error = (more - total) - term;                                    \
            total = counts ? more : total;                                                 \
            correction = counts ? error : correction;                                      \
            if (ERRORS)                                                                    \
                squares = counts ? squares + squares_of(weighted, added.w) : squares;      \
        }                                                                                  \
    }
            if (photons > 0u)
                EACH_PHOTON(photons, gather_powers, VISIT)
#undef VISIT
        }
        if (mine) {
            cursor = walk_cursor();
            finished = has_walked();
        }
    }

    chosen = chosen_of(photons_found(chosen), photons_visited(chosen), last_id, last_left);
    sum = total;
    compensation = correction;
    tally = gather_tally(held, visited, past_excluded, finished);
}
