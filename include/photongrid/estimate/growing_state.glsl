// The states of the search for at least k photons. knn_start.glsl initialises them, knn_visit.glsl advances them;
// knn_result.glsl and grown_radius.glsl read the result.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

// `gathered`: rgb: power of the photons found, W; w: squared distance of the farthest of the first k, m^2.
inline float grown_radius2(vec4 gathered)
{
    return gathered.w;
}

// `found`: x: photons found; y: photons visited (search_tally.glsl reads both); z, w: next photon and end of the row
// that is being read.
inline uvec4 growing_tally(uint found, uint visited, uint next, uint end)
{
    return uvec4(found, visited, next, end);
}
inline uint next_in_row(uvec4 found)
{
    return found.z;
}
inline uint end_of_row(uvec4 found)
{
    return found.w;
}

// `cursor`: ring, z, y, x of the next cell to open; ring NONE: done.
inline uvec4 ring_cursor(uint ring, uint z, uint y, uint x)
{
    return uvec4(ring, z, y, x);
}
inline uint ring_of(uvec4 cursor)
{
    return cursor.x;
}
inline uint cell_z(uvec4 cursor)
{
    return cursor.y;
}
inline uint cell_y(uvec4 cursor)
{
    return cursor.z;
}
inline uint cell_x(uvec4 cursor)
{
    return cursor.w;
}

#endif
