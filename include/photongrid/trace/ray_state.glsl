// How far a ray's search has come: 16 bytes, from which it goes on. The path down the tree needs no stack: bit n of the
// trail says whether, n pairs up, the other child is still to be visited, and pairs know those above them. After
// Barringer and Akenine-Moller, Dynamic Stackless Binary Tree Traversal, JCGT 2(2), 2013.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

const uint NO_TRIANGLE = 0xFFFFFFFFu;

inline bool is_up_to(float most, vec3 v)
{
    return abs(v.x) <= most && abs(v.y) <= most && abs(v.z) <= most;
}
// Whether a ray can hit anything: it has a length, and its coordinates and its direction's length are in range. NaN is
// not.
inline bool is_in_range(vec3 origin, float length, vec3 direction)
{
    return is_up_to(1.0e18f, origin) && is_up_to(1.0e18f, direction) && !is_up_to(1.0e-18f, direction)
        && length > 0.0f;
}

inline uvec4 ray_state(uint pair, uint trail, float distance, uint triangle)
{
    return uvec4(pair, trail, floatBitsToUint(distance), triangle);
}
// The pair to visit next; NO_PAIR: the search is complete.
inline uint pair_of(uvec4 state)
{
    return state.x;
}
inline uint trail_of(uvec4 state)
{
    return state.y;
}
// Of the closest hit so far; without one the ray's length.
inline float distance_of_hit(uvec4 state)
{
    return uintBitsToFloat(state.z);
}
// NO_TRIANGLE: no hit so far.
inline uint triangle_of(uvec4 state)
{
    return state.w;
}

#endif
