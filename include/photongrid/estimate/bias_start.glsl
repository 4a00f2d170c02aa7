// Initialises gather_bias.glsl. Points with w <= 0 and points that are not finite are done at once.
#include <photongrid/estimate/bias_tally.glsl>
#include <photongrid/estimate/row_cursor.glsl>
#include <photongrid/map/grid.glsl>

struct Params {
    uint searching; // 0: nothing can be found (no photons, k = 0, or no radius)
};
PARAMS(Params)
INPUT(0, vec4, points) // xyz: query point, m; w > 0: it has an estimate
OUTPUT(0, vec4, even)
OUTPUT(1, vec4, slope)
OUTPUT(2, vec4, tilt)
OUTPUT(3, vec4, jump)
OUTPUT(4, uvec4, cursor)
OUTPUT(5, uvec4, tally)

void kernel(uint i)
{
    vec4 p = points(i);
    even = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    slope = even;
    tilt = even;
    jump = even;
    cursor = at_first_row();
    tally = bias_tally(!(args.searching != 0u && p.w > 0.0f && is_finite(p)));
}
