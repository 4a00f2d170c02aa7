// A guess at the squared distance of the k-th nearest photon in a block map. Included by kernels after
// search_blocks.glsl. A wrong guess costs time only.

// The squared distance of p from the farthest corner of a node's box.
float node_farthest2(uint node, vec4 p)
{
    return farthest_distance2(boxes(low_corner(node)), boxes(high_corner(node)), p);
}

// The squared distance of the k-th of the photons in a box, if they fill it evenly and there are enough; and not
// less than that of the box. A disc in a square has 2 / pi of the area of the one around it.
float kth_in_box(uint node, vec4 p, float near2, float share)
{
    return near2 + 0.64f * share * (node_farthest2(node, p) - near2);
}

// The least of kth_in_box() of all boxes on the lowest level whose boxes hold a quarter of k photons. A first guess,
// from the way down the tree that goes to the nearest box, spares most of the others.
float guessed_by_boxes(vec4 p, uint k)
{
    uint lowest = args.levels - 1u;
    float share = float(k) * 0.0625f; // of photons sought in those of a box
    for (; lowest > 0u && share > 4.0f; --lowest)
        share = share * 0.0625f;
    uint node = 0u; // the first of 16 siblings
    float guess = 3.4028234e38f;
    for (uint level = 0u; level <= lowest; ++level) {
        uint best = node;
        float best2 = 3.4028234e38f;
        float best_far2 = 3.4028234e38f;
        for (uint n = node; n < node + BLOCK; ++n) {
            float near2 = node_distance2(n, p);
            float far2 = node_farthest2(n, p);
            bool better = near2 < best2 || (near2 == best2 && far2 < best_far2);
            best = better ? n : best;
            best2 = better ? near2 : best2;
            best_far2 = better ? far2 : best_far2;
        }
        guess = kth_in_box(best, p, best2, share);
        node = first_child(best);
    }
    uint steps = 1024u; // loops of a pass are bounded
    for (uvec2 place = at_first_node(); steps > 0u && !has_ended(place); --steps) {
        float near2 = node_distance2(place.x, p);
        bool nearer = near2 < guess;
        if (nearer && place.y == lowest)
            guess = min(guess, kth_in_box(place.x, p, near2, share));
        place = nearer && place.y < lowest ? at_children(place) : after_nodes(place, 1u);
    }
    return guess;
}
