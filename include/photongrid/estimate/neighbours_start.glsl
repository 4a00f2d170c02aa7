// Initialises a list of neighbours (list_neighbours.glsl) or, with GOES_ON, its next part. Points with w <= 0 and
// points that are not finite have empty lists.
#include <photongrid/estimate/list_tally.glsl>
#include <photongrid/estimate/row_cursor.glsl>
#include <photongrid/estimate/search_radius.glsl>
#include <photongrid/map/grid.glsl>

struct Params {
    uint searching; // 0: nothing can be found (no photons, or no radius)
};
PARAMS(Params)
SWITCH(0, GOES_ON)
INPUT(0, vec4, points)  // xyz: query point, m; w > 0: search here
INPUT(1, uvec4, chosen) // see search_radius.glsl
STATE(0, uvec4, cursor)
STATE(1, uvec4, tally)

void kernel(uint i)
{
    vec4 p = points(i);
    if (GOES_ON) {
        tally = list_tally(0u, is_complete(tally), last_id_of(tally), last_id_count(tally));
    } else {
        cursor = at_first_row();
        bool searches = args.searching != 0u && p.w > 0.0f && is_finite(p);
        tally = list_tally(0u, !searches, last_id_of(chosen(i)), last_id_count(chosen(i)));
    }
}
