// The tree of boxes over the photons of a block map (block_map.hpp). Photons are stored in blocks of 16, and each block
// has a box around it; 16 consecutive boxes have a box around them all, and so on up to a level of at most 16 boxes.
// Level 0 is the highest. The children of node v are 16 consecutive nodes, and nodes are numbered so that their places
// need no table:
//     level 0: nodes 0 to 15; level 1: 16 to 271; level 2: 272 to 4,367; ...
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

const uint BLOCK = 16u; // photons in a block, and children of a node

// The first node of a level, 0 to 6: 16 (16^level - 1) / 15.
inline uint first_of_level(uint level)
{
    return 0x01111110u & ((16u << (4u * level)) - 1u);
}

inline uint first_child(uint node)
{
    return BLOCK * (node + 1u);
}

// Where the boxes of a node are stored: 16 lowest corners, then the 16 highest ones, which suits vector registers.
inline uint low_corner(uint node)
{
    return node / BLOCK * (2u * BLOCK) + node % BLOCK;
}
inline uint high_corner(uint node)
{
    return low_corner(node) + BLOCK;
}

const uint END_OF_WALK = 0xFFFFFFFFu;

// A place in a walk through the tree. x: the node to visit next; y: its level, or END_OF_WALK.
inline uvec2 at_first_node()
{
    return uvec2(0u, 0u);
}
inline bool has_ended(uvec2 place)
{
    return place.y == END_OF_WALK;
}
inline uvec2 at_children(uvec2 place)
{
    return uvec2(first_child(place.x), place.y + 1u);
}
// The place after a node and `more` - 1 of its next siblings: the next sibling, or after the last of them the parent's
// next one.
inline uvec2 after_nodes(uvec2 place, uint more)
{
    uint node = place.x + more;
    uint level = place.y;
    while (level != 0u && node % BLOCK == 0u) {
        node = node / BLOCK - 1u;
        --level;
    }
    return uvec2(node, level == 0u && node == BLOCK ? END_OF_WALK : level);
}

// The distance of p from an interval: 0 inside.
inline float distance_from(float low, float high, float p)
{
    precise float below = low - p;
    precise float above = p - high;
    float outside = below > above ? below : above;
    return outside > 0.0f ? outside : 0.0f;
}

// The squared distance, m^2, of p from a box: 0 inside. No photon in the box has a smaller squared distance as
// photon_distance.glsl computes it, since each step here rounds a number that is not larger in the same way.
inline float box_distance2(vec4 low, vec4 high, vec4 p)
{
    float x = distance_from(low.x, high.x, p.x);
    float y = distance_from(low.y, high.y, p.y);
    float z = distance_from(low.z, high.z, p.z);
    precise float d2 = x * x + y * y + z * z;
    return d2 < 1.17549435e-38f ? 0.0f : d2; // denormals count as 0 on every backend
}

// The squared distance, m^2, of p from the farthest corner of a box.
inline float farthest_distance2(vec4 low, vec4 high, vec4 p)
{
    float x = max(high.x - p.x, p.x - low.x);
    float y = max(high.y - p.y, p.y - low.y);
    float z = max(high.z - p.z, p.z - low.z);
    return x * x + y * y + z * z;
}

// A box without photons. Every point is too far from it.
inline vec4 low_of_nothing()
{
    return vec4(3.0e38f, 3.0e38f, 3.0e38f, 0.0f);
}
inline vec4 high_of_nothing()
{
    return vec4(-3.0e38f, -3.0e38f, -3.0e38f, 0.0f);
}
inline vec4 lower_corner(vec4 a, vec4 b)
{
    return vec4(min(a.x, b.x), min(a.y, b.y), min(a.z, b.z), 0.0f);
}
inline vec4 higher_corner(vec4 a, vec4 b)
{
    return vec4(max(a.x, b.x), max(a.y, b.y), max(a.z, b.z), 0.0f);
}

#endif
