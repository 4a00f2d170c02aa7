// What every kernel of a search reads: query points, and the photons cell by cell or block by block. Included after
// PARAMS, whose `leaks` photon_distance.glsl needs.
SWITCH(0, SIDE)
SWITCH(1, NORMALS)
SWITCH(2, FLATTEN)
SWITCH(9, BLOCKS) // a block map, else a grid map
INPUT(0, vec4, points)    // xyz: query point, m
INPUT(1, vec4, normals)   // xyz: unit normal of the surface there
INPUT(2, uvec2, cells)    // grid map: x: first photon, y: count
INPUT(3, vec4, positions) // xyz, m, in the order of the map
INPUT(4, vec4, directions)
INPUT(5, vec4, photon_normals)
