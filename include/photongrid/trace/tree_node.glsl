// The nodes of a tree of boxes over triangles (triangle_tree.hpp), in pairs: the two children of a node. A pair is four
// elements of a buffer:
//     xyz: lowest corner of the first child's box, as bits of floats; w: the first child
//     xyz: highest corner;                                            w: the second child
//     xyz: lowest corner of the second child's box;                   w: the pair and child that this pair is below
//     xyz: highest corner
// A child is a pair or a leaf: up to eight consecutive triangles, each three elements of another buffer, its corners,
// and one of a third, its plane: xyz: unit normal; w: offset; all 0 of a triangle too thin to have one.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

const uint PAIR_RECORDS = 4u;
const uint TRIANGLE_RECORDS = 3u; // xyz: corner, as bits of floats; w of the first: the triangle's index in its mesh
const uint MOST_IN_LEAF = 8u;
const uint DEEPEST_PAIR = 31u; // descents from the first pair: a bit each in ray_state.glsl
const uint NO_PAIR = 0xFFFFFFFFu;

inline uint leaf_of(uint first, uint count)
{
    return 0x80000000u | (count - 1u) << 28u | first;
}
inline bool is_leaf(uint child)
{
    return child >= 0x80000000u;
}
inline uint first_of_leaf(uint child)
{
    return child & 0x0FFFFFFFu;
}
inline uint past_leaf(uint child)
{
    return first_of_leaf(child) + (child >> 28u & 7u) + 1u;
}

// Of a pair: that it is below child 0 or 1 of `pair`.
inline uint below_child(uint pair, uint child)
{
    return pair << 1u | child;
}
inline uint pair_above(uint link)
{
    return link >> 1u;
}
inline uint child_above(uint link)
{
    return link & 1u;
}

inline vec3 corner_of(uvec4 record)
{
    return vec3(uintBitsToFloat(record.x), uintBitsToFloat(record.y), uintBitsToFloat(record.z));
}

#endif
