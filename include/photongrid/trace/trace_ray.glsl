// The hit of a ray among triangles in a tree of boxes: the closest one, of several at one distance that with the least
// index, so that the tree does not decide which it is; or any. A pass takes a bounded number of steps.
//
// With INSTANCES the tree has two levels: leaves of the upper one are instances of surfaces, each with a tree of its
// own. Below such a leaf the ray is in the space of the surface, where distances along it are the same. A hit counts if
// the ray is then inside the instance's box, so that hits do not depend on the upper tree.
#include <photongrid/core/vector.glsl>
#include <photongrid/trace/instance.glsl>
#include <photongrid/trace/ray_state.glsl>
#include <photongrid/trace/ray_tests.glsl>
#include <photongrid/trace/tree_node.glsl>

struct Params {
    uint steps; // the most pairs and triangles to visit in a pass
    uint count; // of instances
};
PARAMS(Params)
SWITCH(0, ANY_HIT)
SWITCH(1, INSTANCES)
INPUT(0, vec4, origins)    // xyz, m; w: length of the ray, in lengths of its direction
INPUT(1, vec4, directions) // xyz
INPUT(2, uvec4, pairs)     // see tree_node.glsl
INPUT(3, uvec4, corners)
INPUT(4, uvec4, instances) // see instance.glsl
INPUT(5, vec4, planes)     // see tree_node.glsl
STATE(0, uvec4, state)     // see ray_state.glsl

#include <photongrid/trace/find_instance.glsl>

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

// The ray in the space of an instance's surface.
Ray ray_in_surface(uint instance, vec3 o, vec3 d)
{
    uint at = INSTANCE_RECORDS * instance;
    precise vec3 from = o - corner_of(instances(at + 3u));
    return ray_of(by_matrix(at, from), by_matrix(at, d));
}

// Where the ray is inside an instance's box.
vec2 inside_instance(uint instance, vec3 o, vec3 d)
{
    uint at = INSTANCE_RECORDS * instance;
    return inside_box(corner_of(instances(at + 4u)), corner_of(instances(at + 5u)), ray_of(o, d));
}

// The number of the first pair of an instance in walks, less its first pair.
uint pairs_before(uint instance)
{
    uint at = INSTANCE_RECORDS * instance;
    return instances(at + PAIR_OF_INSTANCE).w - instances(at + 2u).w;
}

// The closest hit so far.
struct TriangleHit {
    float t; // lengths of the ray's direction
    uint triangle;
};

// The triangles of a leaf. In a surface that an instance stands for: `inside`, where the ray is in the instance's box;
// `first_id`, the number of its first triangle.
TriangleHit closest_of_leaf(TriangleHit so_far, uint leaf, Ray r, vec2 inside, uint first_id)
{
    for (uint n = first_of_leaf(leaf); n < past_leaf(leaf); ++n) {
        uvec4 first = corners(TRIANGLE_RECORDS * n);
        vec3 a = corner_of(first);
        vec3 b = corner_of(corners(TRIANGLE_RECORDS * n + 1u));
        vec3 c = corner_of(corners(TRIANGLE_RECORDS * n + 2u));
        float t = hit_triangle(a, b, c, r);
        uint id = first_id + first.w;
        bool counts = !INSTANCES || (t >= inside.x && t <= inside.y);
        if (counts && t >= 1.17549435e-38f && (t < so_far.t || (t == so_far.t && id < so_far.triangle))
            && !is_behind(planes(n), a, b, c, r)) {
            so_far.t = t;
            so_far.triangle = id;
        }
    }
    return so_far;
}

// What a ray finds at a pair.
struct Visit {
    TriangleHit found;
    uint next;  // the nearer child to go down to, or NO_PAIR
    bool both;  // the other one is to be visited, too
    uint taken; // steps
};

// `above_instances`: leaves are instances, not triangles.
Visit visit_pair(TriangleHit so_far, uint pair, Ray r, bool above_instances, vec2 inside, uint first_id)
{
    Visit v;
    v.found = so_far;
    v.next = NO_PAIR;
    v.both = false;
    v.taken = 1u;
    uvec4 low_0 = pairs(PAIR_RECORDS * pair);
    uvec4 high_0 = pairs(PAIR_RECORDS * pair + 1u);
    uvec4 low_1 = pairs(PAIR_RECORDS * pair + 2u);
    uvec4 high_1 = pairs(PAIR_RECORDS * pair + 3u);
    vec2 first = inside_box(corner_of(low_0), corner_of(high_0), r);
    vec2 second = inside_box(corner_of(low_1), corner_of(high_1), r);
    uint nearer = second.x < first.x ? 1u : 0u;
    for (uint nth = 0u; nth < 2u; ++nth) {
        uint side = nth == 0u ? nearer : 1u - nearer;
        uint child = side == 0u ? low_0.w : high_0.w;
        bool meets = meets_box(side == 0u ? first : second, v.found.t);
        if (meets && (!is_leaf(child) || above_instances)) {
            v.both = v.next != NO_PAIR;
            v.next = v.both ? v.next : child;
        }
        if (meets && is_leaf(child) && !above_instances) {
            v.found = closest_of_leaf(v.found, child, r, inside, first_id);
            v.taken += past_leaf(child) - first_of_leaf(child);
        }
    }
    return v;
}

void kernel(uint i)
{
    vec4 o = origins(i);
    vec3 d = vec3(directions(i));
    Ray r = ray_of(vec3(o), d);
    uint pair = pair_of(state);
    uint trail = trail_of(state);
    TriangleHit found;
    found.t = distance_of_hit(state);
    found.triangle = triangle_of(state);
    uint instance = NO_INSTANCE; // in whose surface the walk is
    vec2 inside = vec2(0.0f, 0.0f);
    uint first_id = 0u;
    uint below = NO_PAIR; // what the instance is below
    uint enters = NO_INSTANCE;
    if (INSTANCES && pair != NO_PAIR && pair >= instances(PAIR_OF_INSTANCE).w) {
        enters = find_instance(args.count, PAIR_OF_INSTANCE, pair);
        pair = pair - pairs_before(enters);
    }

    uint steps = args.steps;
    while (steps > 0u && pair != NO_PAIR) {
        if (INSTANCES && enters != NO_INSTANCE) {
            instance = enters;
            enters = NO_INSTANCE;
            r = ray_in_surface(instance, vec3(o), d);
            inside = inside_instance(instance, vec3(o), d);
            first_id = instances(INSTANCE_RECORDS * instance + ID_OF_INSTANCE).w;
            below = instances(INSTANCE_RECORDS * instance + 3u).w;
        }
        bool above_instances = INSTANCES && instance == NO_INSTANCE;
        Visit v = visit_pair(found, pair, r, above_instances, inside, first_id);
        found = v.found;
        uint taken = v.taken;
        uint next = v.next;
        trail = trail << 1u | (v.both ? 1u : 0u);
        bool climbs = next == NO_PAIR;
        while (climbs) {
            // Up to the closest pair whose other child is still to be visited and near enough.
            ++taken;
            uint link = pairs(PAIR_RECORDS * pair + 2u).w;
            if (INSTANCES && link == NO_PAIR && instance != NO_INSTANCE) {
                link = below;
                instance = NO_INSTANCE;
                r = ray_of(vec3(o), d);
            }
            pair = link == NO_PAIR ? NO_PAIR : pair_above(link);
            trail = trail >> 1u;
            if (pair != NO_PAIR && (trail & 1u) != 0u) {
                trail = trail - 1u;
                uint other = 1u - child_above(link);
                next = meets_box(inside_child(pair, other, r), found.t) ? child_of(pair, other) : NO_PAIR;
            }
            climbs = pair != NO_PAIR && next == NO_PAIR;
        }
        pair = next;
        if (ANY_HIT && found.triangle != NO_TRIANGLE)
            pair = NO_PAIR;
        if (INSTANCES && instance == NO_INSTANCE && pair != NO_PAIR && is_leaf(pair)) {
            enters = first_of_leaf(pair);
            pair = instances(INSTANCE_RECORDS * enters + 2u).w;
        }
        steps -= min(taken, steps);
    }
    if (INSTANCES && pair != NO_PAIR) {
        if (enters != NO_INSTANCE)
            instance = enters;
        pair = instance == NO_INSTANCE ? pair : pair + pairs_before(instance);
    }
    state = ray_state(pair, trail, found.t, found.triangle);
}
