// A first guess at the squared distance of the k-th nearest photon. In a grid map it follows from the cells' counts
// alone: boxes of cells around the query point, each about twice as wide as the one before, until one holds k photons.
// In a block map it follows from the tree's boxes (guess_by_boxes.glsl). A wrong guess costs time only.
#include <photongrid/core/none.glsl>
#include <photongrid/map/block_tree.glsl>
#include <photongrid/map/grid.glsl>
#include <photongrid/estimate/kth_state.glsl>
#include <photongrid/estimate/row_cursor.glsl>

struct Params {
    Grid grid;
    uint k;            // photons sought
    float max_radius2; // m^2
    uint rows;         // the most rows of cells in a box
    uint searching;    // 0: nothing can be found (no photons, k = 0, or no radius)
    uint levels;       // block map: of its tree
    uint in_blocks;    // block map: photons in blocks
};
PARAMS(Params)
SWITCH(9, BLOCKS) // a block map, else a grid map
IN_GROUPS(0)
INPUT(0, vec4, points) // xyz: query point, m; w > 0: search here
INPUT(1, uvec2, cells) // grid map
INPUT(2, vec4, boxes)  // block map: see block_tree.glsl
OUTPUT(0, vec4, pivots) // the states of kth_distance.glsl
OUTPUT(1, uvec4, inner)
OUTPUT(2, uvec4, outer)
OUTPUT(3, uvec4, bracket)
OUTPUT(4, uvec4, cursor)
OUTPUT(5, uvec4, tally)

#include <photongrid/core/group_middle.glsl>
#include <photongrid/estimate/search_blocks.glsl>
#include <photongrid/estimate/guess_by_boxes.glsl>

// The number of photons in a box of cells. The lanes of a group share its rows.
uint photons_inside(uvec4 low, uvec4 high)
{
    uint held = 0u;
    uint rows_y = high.y - low.y + 1u;
    uint rows = rows_y * (high.z - low.z + 1u);
    uint y = low.y;
    uint z = low.z;
    for (uint row = group_lane(); row < rows; row += GROUP_LANES) {
        if (GROUP_LANES > 1u) {
            y = low.y + row % rows_y;
            z = low.z + row / rows_y;
        }
        uint first = cell_number(args.grid, 0u, y, z);
        uvec2 last = cells(first + high.x);
        held += last.x + last.y - cells(first + low.x).x;
        ++y;
        if (y > high.y) {
            y = low.y;
            ++z;
        }
    }
    return lane_value(group_sum_up_to(held), GROUP_LANES - 1u);
}

// The guess for a point in cell c.
float guessed_by_cells(uvec4 c)
{
    uvec4 largest = uvec4(args.grid.resolution.x - 1u, args.grid.resolution.y - 1u, args.grid.resolution.z - 1u, 0u);
    float guess = args.max_radius2;
    uint half_width = 1u;
    uint inside = 0u; // photons of the box before, and its area
    float inside_area = 0.0f;
    bool looking = true;
    while (looking) {
        uvec4 low = uvec4(c.x - min(c.x, half_width), c.y - min(c.y, half_width), c.z - min(c.z, half_width), 0u);
        uvec4 high = uvec4(min(c.x + half_width, largest.x), min(c.y + half_width, largest.y),
            min(c.z + half_width, largest.z), 0u);
        uint rows = high.y - low.y + 1u;
        rows = rows > args.rows ? rows : rows * (high.z - low.z + 1u);
        looking = rows <= args.rows;
        if (looking) {
            uint held = photons_inside(low, high);
            // Photons lie on surfaces: assume that their number is proportional to the largest face of the box, and
            // interpolate between two boxes. A square with 4/pi k photons has an inscribed disc with k photons, whose
            // squared radius is a quarter of the square's area.
            float x = float(high.x - low.x + 1u) * args.grid.cell.x;
            float y = float(high.y - low.y + 1u) * args.grid.cell.y;
            float z = float(high.z - low.z + 1u) * args.grid.cell.z;
            precise float area = max(x * y, max(y * z, z * x));
            if (held > inside) {
                precise float share = (1.2732395f * float(args.k) - float(inside)) / float(held - inside);
                precise float radius2 = 0.25f * (inside_area + (area - inside_area) * share);
                guess = max(radius2, 1e-30f);
            }
            inside = held;
            inside_area = area;
            bool everything = low == uvec4(0u, 0u, 0u, 0u) && high == largest;
            looking = float(held) < 1.2732395f * float(args.k) && !everything;
            half_width *= 2u;
        }
    }
    return min(guess, args.max_radius2);
}

void kernel(uint i)
{
    vec4 p = points(i);
    pivots = pivots_of(0.0f, 0.0f);
    inner = uvec4(0u, 0u, 0u, 0u);
    outer = uvec4(0u, 0u, 0u, 0u);
    bracket = kth_bracket(0u, 0u, 0u, NONE);
    cursor = at_first_row();
    bool searches = args.searching != 0u && p.w > 0.0f && is_finite(p);
    tally = kth_tally(0u, 0u, 0u, searches ? COUNTING : FOUND); // without a search, no photon is found

    uvec4 c = cell_coordinates(args.grid, p);
    bool looking = searches;
    while (group_any(looking)) {
        // Points close to this one can use its guess.
        uint middle = group_middle(looking);
        vec4 there = lane_value(p, middle);
        float guess = args.max_radius2;
        if (BLOCKS)
            guess = min(max(guessed_by_boxes(there, args.k), 1.0e-30f), args.max_radius2);
        else
            guess = guessed_by_cells(lane_value(c, middle));
        float x = p.x - there.x;
        float y = p.y - there.y;
        float z = p.z - there.z;
        bool mine = looking && !(x * x + y * y + z * z > 0.0625f * guess);
        if (mine)
            pivots = pivots_of(0.0f, guess);
        looking = looking && !mine;
    }
}
