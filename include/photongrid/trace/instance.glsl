// The instances of surfaces that stand in a scene several times, under a tree of two levels (instance_tree.hpp). An
// instance is nine elements of a buffer; xyz are bits of floats:
//     three rows of the matrix that turns directions of the scene into those of the surface;
//         w: the number of its first triangle among those of all instances; the number of its first pair in walks,
//         where those of each instance follow on the pairs of the upper level; its first pair
//     where the surface's origin is in the scene, m;                  w: the pair and child that it is below
//     the lowest corner of its box in the scene, m;                   w: its first face (trace/mesh_surface.glsl)
//     the highest one;                                                w: what stands in w of its faces
//     three rows of the matrix from the surface to the scene;         w: IN_PLACE, MIRRORED, or 0; bits of a float,
//         what ray_offset adds for it, m; 0
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

const uint INSTANCE_RECORDS = 9u;
const uint ID_OF_INSTANCE = 0u; // records of numbers by which instances are found
const uint PAIR_OF_INSTANCE = 1u;
const uint NO_INSTANCE = 0xFFFFFFFFu;
const uint IN_PLACE = 1u; // the surface is the scene's own, and its faces say what w of them is
const uint MIRRORED = 2u;

#endif
