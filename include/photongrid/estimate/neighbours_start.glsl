// Initialises a list of neighbours (list_neighbours.glsl) or, with GOES_ON, its next part. Points with w <= 0 and
// points that are not finite have empty lists.
#include <photongrid/map/grid.glsl>

struct Params {
    uint searching; // 0: nothing can be found (no photons, or no radius)
};
PARAMS(Params)
SWITCH(0, GOES_ON)
INPUT(0, vec4, points)  // xyz: query point, m; w > 0: search here
INPUT(1, uvec4, chosen) // see kth_result.glsl
STATE(0, uvec4, cursor)
STATE(1, uvec4, tally)

void kernel(uint i)
{
    vec4 p = points(i);
    if (GOES_ON) {
        tally.x = 0u;
    } else {
        cursor = uvec4(0u, 0u, 0u, 0u);
        bool searches = args.searching != 0u && p.w > 0.0f && is_finite(p);
        tally = uvec4(0u, searches ? 0u : 1u, chosen(i).z, chosen(i).w);
    }
}
