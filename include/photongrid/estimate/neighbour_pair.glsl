// A neighbour as a sortable pair: the bits of its squared distance, which have the order of the distances, and its id.
// Entry e of the list of point p is pair e * points + p, so that consecutive elements read consecutive pairs.
#include <photongrid/core/none.glsl>
#include <photongrid/estimate/list_tally.glsl>

struct Params {
    vec4 leaks;  // see photon_distance.glsl
    uint points;
};
PARAMS(Params)
SWITCH(0, SIDE)
SWITCH(1, NORMALS)
SWITCH(2, FLATTEN)
SWITCH(3, HELD) // off: write empty entries
INPUT(0, vec4, points)
INPUT(1, vec4, normals)
INPUT(2, vec4, positions)
INPUT(3, vec4, directions)
INPUT(4, vec4, photon_normals)
INPUT(5, uint, list)
INPUT(6, uvec4, indices)  // entries 0 to 3, 4 to 7, 8 to 11 or 12 to 15 of a part (list_neighbours.glsl)
INPUT(7, uvec4, tallies)  // see list_tally.glsl
OUTPUT(0, uvec2, pair)

#include <photongrid/estimate/photon_distance.glsl>

void kernel(uint i)
{
    uint entry = i / args.points;
    uint point = i - entry * args.points;
    pair = uvec2(0x7F800000u, NONE); // no photon, infinitely far
    if (HELD) {
        if (entry % 16u < listed_in_part(tallies(point))) {
            uvec4 four = indices(point);
            uint nth = entry % 4u;
            uint at = nth == 0u ? four.x : nth == 1u ? four.y : nth == 2u ? four.z : four.w;
            pair = uvec2(floatBitsToUint(photon_distance2(at, points(point), normals(point))), list(at));
        }
    }
}
