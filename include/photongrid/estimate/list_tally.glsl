// The tally of a list of neighbours. neighbours_start.glsl initialises it, list_neighbours.glsl advances it, and
// neighbour_pair.glsl reads it.
//     x: photons in this part of the list; y: 1: there are no more photons; z: the last id that counts at the radius;
//     w: how often it still counts. z, w: as in `chosen` (search_radius.glsl reads both)
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

inline uvec4 list_tally(uint in_part, bool is_complete, uint last_id, uint last_left)
{
    return uvec4(in_part, is_complete ? 1u : 0u, last_id, last_left);
}
inline uint listed_in_part(uvec4 tally)
{
    return tally.x;
}
inline bool is_complete(uvec4 tally)
{
    return tally.y != 0u;
}

#endif
