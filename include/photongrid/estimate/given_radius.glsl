// The inputs of gather_photons.glsl for a given radius. kth_result.glsl writes the same outputs after a search.
#include <photongrid/core/none.glsl>
#include <photongrid/estimate/search_radius.glsl>

struct Params {
    float radius2;  // m^2
    uint at_points; // 1: points have radii of their own, of which radius2 is the largest allowed
};
PARAMS(Params)
INPUT(0, vec4, points) // w > 0: estimate here; with at_points the squared radius, m^2
OUTPUT(0, vec4, search_radius)
OUTPUT(1, uvec4, chosen)

void kernel(uint i)
{
    float radius2 = args.radius2;
    if (args.at_points != 0u) {
        float own = points(i).w;
        radius2 = own > 0.0f && own < radius2 ? own : radius2;
    }
    search_radius = search_radius_of(radius2, false);
    chosen = chosen_of(0u, 0u, NONE, NONE);
}
