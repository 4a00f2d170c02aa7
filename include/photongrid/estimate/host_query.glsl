// The functions that host_search.hpp shares with the search kernels: a photon's distance, its weight, and the photons
// of a row of cells or of a block that can lie within a radius. No device runs this kernel; it exists so that host and
// devices use the same text.
#include <photongrid/map/block_tree.glsl>
#include <photongrid/map/grid.glsl>

struct Params {
    Grid grid;
    vec4 leaks;     // see photon_distance.glsl
    uint levels;    // block map: of its tree
    uint in_blocks; // block map: photons in blocks
};
PARAMS(Params)
SWITCH(0, SIDE)
SWITCH(1, NORMALS)
SWITCH(2, FLATTEN)
#include <photongrid/estimate/filter.glsl>
INPUT(0, uvec2, cells)         // grid map: x: first photon, y: count
INPUT(1, vec4, positions)      // xyz, m, in the order of the map
INPUT(2, vec4, directions)
INPUT(3, vec4, photon_normals)
INPUT(4, vec4, boxes)          // block map: see block_tree.glsl
OUTPUT(0, float, distance2)

#include <photongrid/estimate/photon_distance.glsl>
#include <photongrid/estimate/search_rows.glsl>
#include <photongrid/estimate/search_blocks.glsl>
#include <photongrid/estimate/guess_by_boxes.glsl>

void kernel(uint i)
{
    distance2 = photon_distance2(i, vec4(0.0f, 0.0f, 0.0f, 1.0f), vec4(0.0f, 0.0f, 1.0f, 0.0f));
}
