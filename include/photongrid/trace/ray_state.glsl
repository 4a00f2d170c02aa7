// How far a ray's search has come: 16 bytes, from which it goes on. The path down the tree needs no stack: bit n of the
// trail says whether, n pairs up, the other child is still to be visited, and pairs know those above them. After
// Barringer and Akenine-Moller, Dynamic Stackless Binary Tree Traversal, JCGT 2(2), 2013.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // backend/begin.hpp

const uint NO_TRIANGLE = 0xFFFFFFFFu;

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
