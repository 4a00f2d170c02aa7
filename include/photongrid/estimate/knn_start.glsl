// Initialises a kNN-grid search (2.3): no photons found, and ring 0, the query point's own cell, is next. Points with
// w <= 0 and points that are not finite are done at once.
#include <photongrid/core/none.glsl>
#include <photongrid/estimate/growing_state.glsl>
#include <photongrid/map/grid.glsl>

struct Params {
    Grid grid;
    uint searching; // 0: nothing can be found (no photons, k = 0, or no radius)
};
PARAMS(Params)
INPUT(0, vec4, points) // xyz: query point, m; w > 0: search here
OUTPUT(0, vec4, gathered)
OUTPUT(1, uvec4, found)
OUTPUT(2, uvec4, cursor)

void kernel(uint i)
{
    vec4 p = points(i);
    uvec4 c = cell_coordinates(args.grid, p);
    gathered = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    found = growing_tally(0u, 0u, 0u, 0u);
    bool searches = args.searching != 0u && p.w > 0.0f && is_finite(p);
    cursor = ring_cursor(searches ? 0u : NONE, c.z, c.y, c.x);
}
