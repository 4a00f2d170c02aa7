// The result of the search for the k-th nearest photon, for kth_tie.glsl and gather_photons.glsl.
#include <photongrid/core/none.glsl>
#include <photongrid/estimate/distance_key.glsl>
#include <photongrid/estimate/kth_state.glsl>
#include <photongrid/estimate/row_cursor.glsl>
#include <photongrid/estimate/search_radius.glsl>
#include <photongrid/estimate/search_tally.glsl>
#include <photongrid/estimate/tie_state.glsl>

struct Params {
    uint k;            // photons sought
    uint photons;      // ids are below this
    float max_radius2; // m^2
    uint rounds_up;    // 1: the radius is the next of a series (radius_series), which holds at least k photons
};
PARAMS(Params)
INPUT(0, uvec4, brackets) // see kth_state.glsl
INPUT(1, uvec4, tallies)
OUTPUT(0, vec4, search_radius) // see search_radius.glsl
OUTPUT(1, uvec4, chosen)
OUTPUT(2, uvec4, bracket) // the states of kth_tie.glsl
OUTPUT(3, uvec4, counts)
OUTPUT(4, uvec4, cursor)

void kernel(uint i)
{
    uint found = photons_found(tallies(i));
    bool kth = found >= args.k && args.k > 0u;
    search_radius = search_radius_of(args.max_radius2, false);
    if (kth)
        search_radius = search_radius_of(distance_of(high_key(brackets(i))), true);
    bool grows = args.rounds_up != 0u;
    if (kth && grows)
        search_radius = search_radius_of(min(next_in_series(radius2_of(search_radius)), args.max_radius2), false);
    bool tie = kth && found > args.k && !grows;
    chosen = chosen_of(found, photons_visited(tallies(i)), NONE, tie ? 0u : NONE);
    bracket = id_bracket(0u, args.photons, 0u, tie ? FIRST_AND_LAST : FOUND_ID);
    counts = uvec4(0u, 0u, 0u, 0u);
    cursor = at_first_row();
}
