// Density estimate from the photons that a search has found so far: irradiance = power / (pi r^2) (Jensen 1996; the
// paper's section 2.3). With fewer than k photons, r is the maximum radius. It has a least value
// (least_disc2), so that coincident photons give a finite result.
#include <photongrid/estimate/growing_state.glsl>
#include <photongrid/estimate/search_radius.glsl>
#include <photongrid/estimate/search_tally.glsl>

struct Params {
    uint k;            // photons sought
    float max_radius2; // m^2
    float min_radius2; // m^2; see least_disc2
};
PARAMS(Params)
INPUT(0, vec4, gathered)    // see growing_state.glsl
INPUT(1, uvec4, found)
INPUT(2, vec4, points)
OUTPUT(0, vec4, irradiance) // rgb: W/m^2; w: squared radius of the photons used, m^2
OUTPUT(1, uvec2, used)      // photons used, photons visited

void kernel(uint i)
{
    vec4 s = gathered(i);
    uint n = photons_found(found(i));
    float radius2 = n < args.k ? args.max_radius2 : grown_radius2(s);
    float disc2 = max(radius2, least_disc2(points(i), args.min_radius2));
    float per_area = 1.0f / (3.14159265f * disc2);
    irradiance = vec4(0.0f, 0.0f, 0.0f, radius2);
    if (n > 0u)
        irradiance = vec4(s.x * per_area, s.y * per_area, s.z * per_area, radius2);
    used = uvec2(n, photons_visited(found(i)));
}
