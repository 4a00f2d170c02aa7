// The states of the search for the k-th nearest photon. kth_guess.glsl initialises them, kth_distance.glsl advances
// them, and kth_result.glsl reads the result.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

// Phases
const uint COUNTING = 0u;   // scans count photons within eight pivots
const uint CLOSING_IN = 1u; // scans have one pivot and keep its neighbours
const uint FOUND = 2u;

// `tally`: x: photons within the pivot (once FOUND: within the k-th distance); y: photons visited (search_tally.glsl
// reads both); z: scans; w: phase.
inline uvec4 kth_tally(uint within, uint visited, uint scans, uint phase)
{
    return uvec4(within, visited, scans, phase);
}
inline uint scans_of(uvec4 tally)
{
    return tally.z;
}
inline uint kth_phase(uvec4 tally)
{
    return tally.w;
}

// `pivots`, m^2: COUNTING: eight pivots, at x plus y times a factor; CLOSING_IN: x is the only pivot.
inline vec4 pivots_of(float base, float span)
{
    return vec4(base, span, 0.0f, 0.0f);
}
inline float pivot_base(vec4 pivots)
{
    return pivots.x;
}
inline float pivot_span(vec4 pivots)
{
    return pivots.y;
}

// `bracket`: x < key of the k-th <= y (distance_key.glsl; once FOUND: y is its key); z, w: photons with keys up to x,
// and up to y; w is NONE until a pivot beyond the k-th is known.
inline uvec4 kth_bracket(uint low_key, uint high_key, uint up_to_low, uint up_to_high)
{
    return uvec4(low_key, high_key, up_to_low, up_to_high);
}
inline uint low_key(uvec4 bracket)
{
    return bracket.x;
}
inline uint high_key(uvec4 bracket)
{
    return bracket.y;
}
inline uint up_to_low(uvec4 bracket)
{
    return bracket.z;
}
inline uint up_to_high(uvec4 bracket)
{
    return bracket.w;
}

#endif
