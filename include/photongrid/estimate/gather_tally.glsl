// The tally of gather_photons.glsl: x: photons within the radius, with the excluded one; y: photons visited
// (search_tally.glsl reads both); z: index + 1 of the photon excluded so far, 0: none; w: 1: done.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

inline uvec4 gather_tally(uint found, uint visited, uint past_excluded, bool is_done)
{
    return uvec4(found, visited, past_excluded, is_done ? 1u : 0u);
}
inline uint past_excluded_of(uvec4 tally)
{
    return tally.z;
}
inline bool is_gathered(uvec4 tally)
{
    return tally.w != 0u;
}

#endif
