// Initialises gather_photons.glsl. Points with w <= 0 and points that are not finite are done at once.
#include <photongrid/estimate/gather_tally.glsl>
#include <photongrid/estimate/row_cursor.glsl>
#include <photongrid/estimate/search_tally.glsl>
#include <photongrid/map/grid.glsl>

struct Params {
    uint searching; // 0: nothing can be found (no photons, k = 0, or no radius)
};
PARAMS(Params)
INPUT(0, vec4, points) // xyz: query point, m; w > 0: estimate here
INPUT(1, uvec4, chosen) // see search_radius.glsl
OUTPUT(0, vec4, sum)
OUTPUT(1, vec4, compensation)
OUTPUT(2, vec4, squares)
OUTPUT(3, uvec4, cursor)
OUTPUT(4, uvec4, tally)

void kernel(uint i)
{
    vec4 p = points(i);
    sum = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    compensation = sum;
    squares = sum;
    cursor = at_first_row();
    bool searches = args.searching != 0u && p.w > 0.0f && is_finite(p);
    tally = gather_tally(0u, photons_visited(chosen(i)), 0u, !searches);
}
