// The blocks of a block map that can hold photons within a radius. Included by kernels after their `boxes` input.

// The squared distance of p from a node's box.
float node_distance2(uint node, vec4 p)
{
    return box_distance2(boxes(low_corner(node)), boxes(high_corner(node)), p);
}

// Whether a node's box reaches into the ball of radius2 around p.
bool is_near(uint node, vec4 p, float radius2) { return node_distance2(node, p) <= radius2; }

bool is_block(uvec2 place)
{
    return place.y + 1u == args.levels;
}

// The first and one past the last photon of a block.
uvec2 photons_of_block(uint node)
{
    uint first = (node - first_of_level(args.levels - 1u)) * BLOCK;
    return uvec2(first, min(first + BLOCK, args.in_blocks));
}
