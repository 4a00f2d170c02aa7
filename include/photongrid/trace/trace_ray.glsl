// The hit of a ray among triangles in a tree of boxes: the closest one, of several at one distance that with the least
// index, so that the tree does not decide which it is; or any. A pass takes a bounded number of steps.
#include <photongrid/trace/ray_state.glsl>
#include <photongrid/trace/ray_tests.glsl>
#include <photongrid/trace/tree_node.glsl>

struct Params {
    uint steps; // the most pairs and triangles to visit in a pass
};
PARAMS(Params)
SWITCH(0, ANY_HIT)
INPUT(0, vec4, origins)    // xyz, m; w: length of the ray, in lengths of its direction
INPUT(1, vec4, directions) // xyz
INPUT(2, uvec4, pairs)     // see tree_node.glsl
INPUT(3, uvec4, corners)
STATE(0, uvec4, state)     // see ray_state.glsl

bool done()
{
    return pair_of(state) == NO_PAIR;
}

// Where the ray is inside a child of a pair.
vec2 inside_child(uint pair, uint child, Ray r)
{
    uint at = PAIR_RECORDS * pair + 2u * child;
    return inside_box(corner_of(pairs(at)), corner_of(pairs(at + 1u)), r);
}
uint child_of(uint pair, uint child)
{
    return pairs(PAIR_RECORDS * pair + child).w;
}

void kernel(uint i)
{
    vec4 o = origins(i);
    Ray r = ray_of(vec3(o), vec3(directions(i)));
    uint pair = pair_of(state);
    uint trail = trail_of(state);
    float closest = distance_of_hit(state);
    uint triangle = triangle_of(state);

    uint steps = args.steps;
    while (steps > 0u && pair != NO_PAIR) {
        uint taken = 1u;
        vec2 first = inside_child(pair, 0u, r);
        vec2 second = inside_child(pair, 1u, r);
        uint nearer = second.x < first.x ? 1u : 0u;
        uint next = NO_PAIR;
        bool both = false;
        for (uint nth = 0u; nth < 2u; ++nth) {
            uint side = nth == 0u ? nearer : 1u - nearer;
            uint child = child_of(pair, side);
            bool meets = meets_box(side == 0u ? first : second, closest);
            if (meets && !is_leaf(child)) {
                both = next != NO_PAIR;
                next = both ? next : child;
            }
            if (meets && is_leaf(child)) {
                for (uint n = first_of_leaf(child); n < past_leaf(child); ++n) {
                    uvec4 a = corners(TRIANGLE_RECORDS * n);
                    float t = hit_triangle(corner_of(a), corner_of(corners(TRIANGLE_RECORDS * n + 1u)),
                        corner_of(corners(TRIANGLE_RECORDS * n + 2u)), r);
                    if (t >= 1.17549435e-38f && (t < closest || (t == closest && a.w < triangle))) {
                        closest = t;
                        triangle = a.w;
                    }
                    ++taken;
                }
            }
        }
        trail = trail << 1u | (both ? 1u : 0u);
        bool climbs = next == NO_PAIR;
        while (climbs) {
            // Up to the closest pair whose other child is still to be visited and near enough.
            ++taken;
            uint link = pairs(PAIR_RECORDS * pair + 2u).w;
            pair = link == NO_PAIR ? NO_PAIR : pair_above(link);
            trail = trail >> 1u;
            if (pair != NO_PAIR && (trail & 1u) != 0u) {
                trail = trail - 1u;
                uint other = 1u - child_above(link);
                next = meets_box(inside_child(pair, other, r), closest) ? child_of(pair, other) : NO_PAIR;
            }
            climbs = pair != NO_PAIR && next == NO_PAIR;
        }
        pair = next;
        if (ANY_HIT && triangle != NO_TRIANGLE)
            pair = NO_PAIR;
        steps -= min(taken, steps);
    }
    state = ray_state(pair, trail, closest, triangle);
}
