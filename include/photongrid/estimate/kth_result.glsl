// The result of the search for the k-th nearest photon, for kth_tie.glsl and gather_photons.glsl.
#include <photongrid/backend/none.glsl>
#include <photongrid/estimate/distance_key.glsl>
#include <photongrid/estimate/tie_phases.glsl>

struct Params {
    uint k;            // photons sought
    uint photons;      // ids are below this
    float max_radius2; // m^2
};
PARAMS(Params)
INPUT(0, uvec4, brackets)
INPUT(1, uvec4, tallies)
OUTPUT(0, vec4, search_radius) // x: squared radius, m^2; y: 1 if a photon set it, 0 if it was given
OUTPUT(1, uvec4, chosen)       // photons within; photons visited; the last id that counts at the radius itself; how
                               // often that id counts there, since routed maps repeat photons
OUTPUT(2, uvec4, bracket)      // of ids, see kth_tie.glsl
OUTPUT(3, uvec4, counts)
OUTPUT(4, uvec4, cursor)

void kernel(uint i)
{
    uvec4 between = brackets(i);
    uvec4 tally = tallies(i);
    bool kth = tally.x >= args.k && args.k > 0u;
    search_radius = vec4(args.max_radius2, 0.0f, 0.0f, 0.0f);
    if (kth)
        search_radius = vec4(distance_of(between.y), 1.0f, 0.0f, 0.0f);
    bool tie = kth && tally.x > args.k;
    chosen = uvec4(tally.x, tally.y, NONE, tie ? 0u : NONE);
    bracket = uvec4(0u, args.photons, 0u, tie ? FIRST_AND_LAST : FOUND_ID);
    counts = uvec4(0u, 0u, 0u, 0u);
    cursor = uvec4(0u, 0u, 0u, 0u);
}
