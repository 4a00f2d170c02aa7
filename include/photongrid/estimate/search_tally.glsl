// The tally of a search. Each stage packs its own, but the first two lanes of all are the same:
//     x: photons found within the radius so far; y: photons visited
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

inline uvec4 search_tally(uint found, uint visited)
{
    return uvec4(found, visited, 0u, 0u);
}
inline uint photons_found(uvec4 tally)
{
    return tally.x;
}
inline uint photons_visited(uvec4 tally)
{
    return tally.y;
}

#endif
