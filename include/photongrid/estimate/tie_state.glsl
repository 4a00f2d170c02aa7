// The states of the search for the last id at a radius. kth_result.glsl initialises them, and kth_tie.glsl advances
// them.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

// Phases
const uint FIRST_AND_LAST = 0u; // finding the smallest and the largest id
const uint COUNTING_IDS = 1u;
const uint FOUND_ID = 2u;

// `bracket`: x <= id < y; z: photons of this scan that are nearer than the radius; w: phase.
inline uvec4 id_bracket(uint first, uint past, uint nearer, uint phase)
{
    return uvec4(first, past, nearer, phase);
}
inline uint first_id(uvec4 bracket)
{
    return bracket.x;
}
inline uint past_id(uvec4 bracket)
{
    return bracket.y;
}
inline uint photons_nearer(uvec4 bracket)
{
    return bracket.z;
}
inline uint tie_phase(uvec4 bracket)
{
    return bracket.w;
}

#endif
