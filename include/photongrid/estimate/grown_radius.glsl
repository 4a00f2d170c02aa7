// The inputs of gather_photons.glsl after the at-least-k search (knn_visit.glsl). kth_result.glsl writes the same
// outputs.
#include <photongrid/core/none.glsl>
#include <photongrid/estimate/growing_state.glsl>
#include <photongrid/estimate/search_radius.glsl>
#include <photongrid/estimate/search_tally.glsl>

struct Params {
    uint k;            // photons sought
    float max_radius2; // m^2
};
PARAMS(Params)
INPUT(0, vec4, gathered) // see growing_state.glsl
INPUT(1, uvec4, found)
OUTPUT(0, vec4, search_radius)
OUTPUT(1, uvec4, chosen)

void kernel(uint i)
{
    uvec4 tally = found(i);
    bool enough = photons_found(tally) >= args.k && args.k > 0u;
    search_radius = search_radius_of(enough ? grown_radius2(gathered(i)) : args.max_radius2, enough);
    chosen = chosen_of(photons_found(tally), photons_visited(tally), NONE, NONE);
}
