// Where a scan of a map goes on in its next pass, or a walk (photon_walk.glsl):
//     x, y: grid map: y and z of the next row; block map: the next node and its level (block_tree.glsl)
//     z: the first photon not yet visited; w: the walk's phase, else 0
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

inline uvec4 row_cursor(uint y, uint z, uint photon)
{
    return uvec4(y, z, photon, 0u);
}
inline uvec4 at_first_row()
{
    return uvec4(0u, 0u, 0u, 0u);
}
inline uint row_y(uvec4 cursor)
{
    return cursor.x;
}
inline uint row_z(uvec4 cursor)
{
    return cursor.y;
}
inline uvec4 node_cursor(uvec2 place, uint photon)
{
    return uvec4(place.x, place.y, photon, 0u);
}
inline uvec2 next_node(uvec4 cursor)
{
    return uvec2(cursor.x, cursor.y);
}
inline uint first_unvisited(uvec4 cursor)
{
    return cursor.z;
}
inline uint phase_of_walk(uvec4 cursor)
{
    return cursor.w;
}
inline uvec4 in_phase(uvec4 cursor, uint phase)
{
    return uvec4(cursor.x, cursor.y, cursor.z, phase);
}

#endif
