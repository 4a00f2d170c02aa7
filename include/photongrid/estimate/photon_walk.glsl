// Visits the photons near the query points of a subgroup (IN_GROUPS, core/begin.hpp), or near a single point, in map
// order. At each step every lane looks up one row of cells, or tests one box of a block map; then, chunk by chunk,
// every lane loads one photon of these rows or blocks and broadcasts it to the others. Included by kernels after
// search_rows.glsl, search_blocks.glsl and photon_distance.glsl, and after row_cursor.glsl.
#include <photongrid/core/group_middle.glsl>

// The union of the points' search balls is inside this ball: its centre, the centre's cell, and the squared radius.
vec4 walk_center;
uvec4 walk_cell;
float walk_radius2;
uvec2 walk_y; // first and last row of cells in the ball, along y
uvec2 walk_z; // and along z
uint walk_next_y;      // the next row
uint walk_next_z;
uvec2 walk_place;      // block map: the next node
uint walk_unvisited;   // the first photon not yet visited
uint walk_phase;       // of the searches that share the walk
uint walk_visits = 0u; // photons left in this pass's budget
uint walk_steps = 0u;  // steps left in this pass's budget
uint rows_end = 0u;    // inclusive prefix sum over the lanes of the photons in their current rows
uint rows_shift = 0u;  // this lane's row: difference between a photon's index in the map and its number in the rows
uint chunk_index = 0u; // index of the photon that this lane loads
LANE_VARIABLE(vec4, chunk_position)
LANE_VARIABLE(vec4, chunk_direction)
LANE_VARIABLE(vec4, chunk_normal)

// Begins a walk for the unfinished point in the centre of the subgroup and the points that can share its walk: those
// that are close to it and go on at the same photon in the same phase (`resume_at`, row_cursor.glsl). Returns whether
// this point is one of them.
bool joins_walk(bool searching, vec4 p, uvec4 c, float radius2, uvec4 resume_at)
{
    uint middle = group_middle(searching);
    float radius = wider(radius2);
    walk_center = lane_value(p, middle);
    walk_cell = lane_value(c, middle);
    uvec4 start_at = lane_value(resume_at, middle);
    float most = lane_value(radius, middle);
    float dx = abs(p.x - walk_center.x);
    float dy = abs(p.y - walk_center.y);
    float dz = abs(p.z - walk_center.z);
    bool mine = searching && !(max(dx, max(dy, dz)) > 0.4f * most) && !(radius > 1.5f * most) && resume_at == start_at;
    walk_radius2 = radius2;
    if (GROUP_LANES > 1u) {
        float extent = mine ? (sqrt(dx * dx + dy * dy + dz * dz) + radius) * 1.000001f : 0.0f;
        radius = uintBitsToFloat(group_max(floatBitsToUint(extent)));
        walk_radius2 = radius * radius * 1.000001f;
    }
    walk_unvisited = first_unvisited(start_at);
    walk_phase = phase_of_walk(start_at);
    if (BLOCKS) {
        walk_place = next_node(start_at);
        return mine;
    }
    walk_y = cells_within(walk_center.y, radius, args.grid.origin.y, args.grid.inverse_cell.y, args.grid.resolution.y);
    walk_z = cells_within(walk_center.z, radius, args.grid.origin.z, args.grid.inverse_cell.z, args.grid.resolution.z);
    walk_next_y = row_y(start_at);
    walk_next_z = row_z(start_at);
    if (walk_next_z < walk_z.x) {
        walk_next_y = 0u;
        walk_next_z = walk_z.x;
    }
    walk_next_y = max(walk_next_y, walk_y.x);
    if (walk_next_y > walk_y.y) {
        walk_next_y = walk_y.x;
        ++walk_next_z;
    }
    return mine;
}

uvec4 walk_cursor()
{
    if (BLOCKS)
        return node_cursor(walk_place, walk_unvisited);
    return row_cursor(walk_next_y, walk_next_z, walk_unvisited);
}
bool has_walked()
{
    if (BLOCKS)
        return has_ended(walk_place);
    return walk_next_z > walk_z.y;
}
bool walks_on() { return walk_steps > 0u && !has_walked(); }

// The index in the map of photon `nth` of the current rows.
uint index_of(uint nth)
{
    uint row = 0u;
    for (uint step = GROUP_LANES / 2u; step > 0u; step /= 2u)
        row += lane_value(rows_end, row + step - 1u) <= nth ? step : 0u;
    return nth + lane_value(rows_shift, row);
}

// Makes the photons of each lane's range the current rows. Returns how many there are, limited by the pass's budget.
uint take_ranges(uvec2 photons)
{
    uint first = max(photons.x, walk_unvisited);
    uint held = first < photons.y ? photons.y - first : 0u;
    rows_end = group_sum_up_to(held);
    rows_shift = first - (rows_end - held);
    uint all = lane_value(rows_end, GROUP_LANES - 1u);
    if (all > walk_visits) {
        all = walk_visits;
        walk_unvisited = index_of(all);
        walk_steps = 0u;
    }
    walk_visits -= all;
    return all;
}
bool took_all(uint photons) { return photons == lane_value(rows_end, GROUP_LANES - 1u); }

// Advances by one row per lane. Returns the number of photons to visit in these rows.
uint next_cells()
{
    uint y = walk_next_y;
    uint z = walk_next_z;
    if (GROUP_LANES > 1u) { // not by a loop: drivers that end loops early count the iterations of all of them
        uint rows = walk_y.y - walk_y.x + 1u;
        uint on = y - walk_y.x + group_lane();
        z += on / rows;
        y = walk_y.x + on % rows;
    }
    uvec2 row = photons_of_row(walk_center, y, min(z, walk_z.y), walk_cell, walk_radius2);
    uint photons = take_ranges(z <= walk_z.y ? row : uvec2(0u, 0u));
    if (took_all(photons)) {
        walk_next_y = lane_value(y, GROUP_LANES - 1u) + 1u;
        walk_next_z = lane_value(z, GROUP_LANES - 1u);
        if (walk_next_y > walk_y.y) {
            walk_next_y = walk_y.x;
            ++walk_next_z;
        }
    }
    return photons;
}

// Advances by one box per lane. Returns the number of photons to visit in these boxes, if they are blocks.
uint next_boxes()
{
    uint tested = min(GROUP_LANES, BLOCK - walk_place.x % BLOCK); // siblings only
    uint node = walk_place.x + min(group_lane(), tested - 1u);
    bool near = is_near(node, walk_center, walk_radius2) && group_lane() < tested;
    uvec2 after = after_nodes(walk_place, tested);
    uint photons = 0u;
    if (is_block(walk_place)) {
        photons = take_ranges(near ? photons_of_block(node) : uvec2(0u, 0u));
        walk_place = took_all(photons) ? after : walk_place;
    } else {
        uint first = group_min(near ? group_lane() : GROUP_LANES);
        walk_place = first < GROUP_LANES ? at_children(uvec2(walk_place.x + first, walk_place.y)) : after;
    }
    return photons;
}

// Advances to the next rows or blocks that hold photons to visit, or to the end of the walk or of the pass's budget.
// Returns the number of these photons.
uint next_rows()
{
    uint photons = 0u;
    --walk_steps; // for the caller's loop
    if (!BLOCKS)
        return next_cells();
    // A loop of its own: lanes that run in lockstep then look for blocks together, and visit photons together.
    while (photons == 0u && walks_on()) {
        uint level = walk_place.y;
        photons = next_boxes();
        uint loops = 1u + level - min(level, walk_place.y); // after_nodes() has one per level that it climbs
        walk_steps -= min(loops, walk_steps);
    }
    return photons;
}

// Loads photons nth, nth + 1, ... of the `all` photons in the current rows, one per lane. Lanes past the last photon
// get one that is far from everything.
void gather_chunk(uint nth, uint all)
{
    uint mine = nth + group_lane();
    chunk_index = index_of(min(mine, all - 1u));
    vec4 position = positions(chunk_index);
    if (GROUP_LANES > 1u && mine >= all)
        position.x = 3.0e38f;
    vec4 direction = position;
    vec4 normal = position;
    if (SIDE)
        direction = directions(chunk_index);
    if (NORMALS)
        normal = photon_normals(chunk_index);
    set_lane(chunk_position, position);
    set_lane(chunk_direction, direction);
    set_lane(chunk_normal, normal);
}
#define PHOTON_OF(LANE) from_lane(chunk_position, LANE), from_lane(chunk_direction, LANE), from_lane(chunk_normal, LANE)
// VISIT(LANE) for each of the PHOTONS, at least one, in the current rows. GATHER is gather_chunk or a function that
// loads more, by which each lane sets its LANE_VARIABLEs.
#define EACH_PHOTON(PHOTONS, GATHER, VISIT)  \
    {                                        \
        uint nth = 0u;                       \
        do {                                 \
            begin_lanes();                   \
            GATHER(nth, PHOTONS);            \
            end_lanes();                     \
            EACH_LANE(VISIT)                 \
            nth += GROUP_LANES;              \
        } while (nth < PHOTONS);             \
    }
