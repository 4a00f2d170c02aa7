// The inputs of gather_photons.glsl for a given radius. kth_result.glsl writes the same outputs after a search.
#include <photongrid/backend/none.glsl>
#include <photongrid/estimate/search_radius.glsl>

struct Params {
    float radius2; // m^2
};
PARAMS(Params)
OUTPUT(0, vec4, search_radius)
OUTPUT(1, uvec4, chosen)

void kernel(uint i)
{
    search_radius = search_radius_of(args.radius2, false);
    chosen = chosen_of(0u, 0u, NONE, NONE);
}
