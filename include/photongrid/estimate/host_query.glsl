// The functions that host_search.hpp shares with the search kernels: a photon's distance, its weight, and the photons
// of a row of cells that can lie within a radius. No device runs this kernel; it exists so that host and devices use
// the same text.
#include <photongrid/map/grid.glsl>

struct Params {
    Grid grid;
    vec4 leaks; // see photon_distance.glsl
};
PARAMS(Params)
SWITCH(0, SIDE)
SWITCH(1, NORMALS)
SWITCH(2, FLATTEN)
#include <photongrid/estimate/filter.glsl>
INPUT(0, uvec2, cells)         // x: first photon, y: count
INPUT(1, vec4, positions)      // xyz, m, cell by cell
INPUT(2, vec4, directions)
INPUT(3, vec4, photon_normals)
OUTPUT(0, float, distance2)

#include <photongrid/estimate/photon_distance.glsl>
#include <photongrid/estimate/search_rows.glsl>

void kernel(uint i)
{
    distance2 = photon_distance2(i, vec4(0.0f, 0.0f, 0.0f, 1.0f), vec4(0.0f, 0.0f, 1.0f, 0.0f));
}
