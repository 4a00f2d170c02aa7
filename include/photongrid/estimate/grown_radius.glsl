// The inputs of gather_photons.glsl after the at-least-k search (knn_visit.glsl). kth_result.glsl writes the same
// outputs.
#include <photongrid/backend/none.glsl>

struct Params {
    uint k;            // photons sought
    float max_radius2; // m^2
};
PARAMS(Params)
INPUT(0, vec4, gathered)
INPUT(1, uvec4, found)
OUTPUT(0, vec4, search_radius)
OUTPUT(1, uvec4, chosen)

void kernel(uint i)
{
    uvec4 n = found(i);
    bool enough = n.x >= args.k && args.k > 0u;
    search_radius = vec4(enough ? gathered(i).w : args.max_radius2, enough ? 1.0f : 0.0f, 0.0f, 0.0f);
    chosen = uvec4(n.x, n.y, NONE, NONE);
}
