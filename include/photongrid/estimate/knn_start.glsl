// The beginning of a kNN-grid search (2.3): nothing found, about to open ring 0, the cell of the query point itself.
// A point that is not wanted (w <= 0) or not finite is done at once.
#include <photongrid/map/grid.glsl>

struct Params {
    Grid grid;
    uint searching; // 0: no search can find anything (no photons, none wanted, no radius)
};
PARAMS(Params)
INPUT(0, vec4, points) // xyz: query point, m; w > 0: wanted
OUTPUT(0, vec4, gathered)
OUTPUT(1, uvec4, found)
OUTPUT(2, uvec4, cursor)

void kernel(uint i)
{
    vec4 p = points(i);
    uvec4 c = cell_coordinates(args.grid, p);
    gathered = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    found = uvec4(0u, 0u, 0u, 0u);
    bool searches = args.searching != 0u && p.w > 0.0f && is_finite(p);
    cursor = uvec4(searches ? 0u : 0xFFFFFFFFu, c.z, c.y, c.x);
}
