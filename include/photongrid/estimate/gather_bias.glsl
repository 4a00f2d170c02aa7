// Sums, over the photons within the radius of an estimate, from which bias_estimate.glsl computes its bias. The photon
// that sets the radius is not among them: without it the means of the sums are right (gather_photons.glsl).
//
// All sums are plain ones. Rounding adds less than 1e-6 of the light to them for 1,000 photons, and they are of use as
// parts of the light.
#include <photongrid/core/vector.glsl>
#include <photongrid/estimate/bias_tally.glsl>
#include <photongrid/estimate/half_space.glsl>
#include <photongrid/estimate/row_cursor.glsl>
#include <photongrid/estimate/search_radius.glsl>
#include <photongrid/map/block_tree.glsl>
#include <photongrid/map/grid.glsl>

struct Params {
    Grid grid;
    vec4 leaks;        // see photon_distance.glsl
    float min_radius2; // m^2; see least_disc2
    float in_plane;    // 1: only the part of an offset that lies in the surface counts; 0: there are no normals
    uint visits;       // the most photons to examine in a pass ...
    uint ranges;       // ... and the most rows of cells or boxes
    uint levels;       // block map: of its tree
    uint in_blocks;    // block map: photons in blocks
};
PARAMS(Params)
#include <photongrid/estimate/search_inputs.glsl>
SWITCH(10, HALVED) // points may have half spaces
IN_GROUPS(8)
INPUT(6, vec4, powers)       // rgb, W
INPUT(7, vec4, boxes)        // block map: see block_tree.glsl
INPUT(8, vec4, irradiances)  // w: squared radius of the estimate, m^2
STATE(0, vec4, even)         // rgb: power, W
STATE(1, vec4, slope)        // rgb: power times curve_weight, W
STATE(2, vec4, tilt)         // xyz: mean power of the channels times offset / radius, W
STATE(3, vec4, jump)         // xyz: the same times jump_weight, W
STATE(4, uvec4, cursor)      // see row_cursor.glsl
STATE(5, uvec4, tally)       // see bias_tally.glsl

#include <photongrid/estimate/bias_weights.glsl>
#include <photongrid/estimate/photon_distance.glsl>
#include <photongrid/estimate/search_rows.glsl>
#include <photongrid/estimate/search_blocks.glsl>
#include <photongrid/estimate/photon_walk.glsl>

LANE_VARIABLE(vec4, chunk_power)
void gather_powers(uint nth, uint all)
{
    gather_chunk(nth, all);
    set_lane(chunk_power, powers(chunk_index));
}

bool done()
{
    return has_bias(tally);
}

void kernel(uint i)
{
    vec4 p = points(i);
    vec4 n = normals(i);
    uvec4 c = cell_coordinates(args.grid, p);
    float radius2 = irradiances(i).w;
    float disc2 = max(radius2, least_disc2(p, args.min_radius2));
    float inverse_disc2 = 1.0f / disc2;
    float inverse_radius = 1.0f / sqrt(disc2);
    precise vec4 total = even;
    precise vec4 curved = slope;
    precise vec4 moment = tilt;
    precise vec4 bent = jump;
    uvec4 resume_at = cursor;
    bool finished = has_bias(tally);
    HalfSpace before = half_space_of(vec4(n.x, n.y, n.z, HALVED ? n.w : 0.0f), sqrt(p.w));

    walk_visits = args.visits;
    walk_steps = args.ranges;
    while (walk_steps > 0u && group_any(!finished)) {
        bool mine = joins_walk(!finished, p, c, radius2, resume_at);
        vec4 from = vec4(mine ? p.x : -3.0e38f, p.y, p.z, 0.0f); // the other lanes find nothing
        while (walks_on()) {
            uint photons = next_rows();
#define VISIT(LANE)                                                                     \
    {                                                                                   \
        float d2 = distance2_of(PHOTON_OF(LANE), from, n);                              \
        if (GROUP_LANES > 1u || d2 < radius2) {                                         \
            vec4 q = from_lane(chunk_position, LANE);                                   \
            if (HALVED && is_beyond(before, q.x - p.x, q.y - p.y, q.z - p.z))           \
                d2 = 3.4028234e38f;                                                     \
            vec4 power = from_lane(chunk_power, LANE);                                  \
            bool counts = d2 < radius2;                                                 \
            float t = d2 * inverse_disc2;                                               \
            t = t < 1.0f ? t : 1.0f;                                                    \
            float dx = q.x - p.x;                                                       \
            float dy = q.y - p.y;                                                       \
            float dz = q.z - p.z;                                                       \
            float above = (dx * n.x + dy * n.y + dz * n.z) * args.in_plane;             \
            float flux = (power.x + power.y + power.z) * 0.333333333f * inverse_radius; \
            vec4 offset = vec4((dx - above * n.x) * flux, (dy - above * n.y) * flux,    \
                (dz - above * n.z) * flux, 0.0f);                                       \
            total = counts ? total + power : total;                                     \
            curved = counts ? curved + power * curve_weight(t) : curved;                \
            moment = counts ? moment + offset : moment;                                 \
            bent = counts ? bent + offset * jump_weight(t) : bent;                      \
        }                                                                               \
    }
            if (photons > 0u)
                EACH_PHOTON(photons, gather_powers, VISIT)
#undef VISIT
        }
        if (mine) {
            resume_at = walk_cursor();
            finished = has_walked();
        }
    }

    even = total;
    slope = curved;
    tilt = moment;
    jump = bent;
    cursor = resume_at;
    tally = bias_tally(finished);
}
