// Chooses a light for a sample, where there are many: down a tree of lights, from its root on, by estimates of each
// half's irradiance without shadows (Conty Estevez and Kulla, Importance Sampling of Many Lights with Adaptive Tree
// Splitting, 2018). Lights from outside of the scene are not in the tree: each is estimated. Included by kernels after
// trace/lights.glsl.

// A child of a node (trace/light_tree.hpp): a node, or below 0 a light.
uint light_of_child(float child)
{
    return uint(-1.0f - child);
}
float child_importance(float child, LitPoint lit)
{
    if (child < 0.0f) {
        return light_importance(light_at(light_of_child(child)), lit);
    }
    uint at = table_of(scene(LIGHT_TREE)).first + 2u * uint(child);
    vec4 ball = scene(at);
    return ball_importance(vec3(ball), ball.w, scene(at + 1u).x, lit);
}

struct ChosenLight {
    uint number;
    float probability; // 0: none gives any light
};

// Of the light in a tree, for u from 0 to 1.
ChosenLight light_in_tree(float root, LitPoint lit, float u)
{
    ChosenLight c;
    c.number = 0u;
    c.probability = 1.0f;
    float child = root;
    uint first = table_of(scene(LIGHT_TREE)).first;
    for (uint level = 0u; child >= 0.0f && level < 32u; ++level) {
        vec4 node = scene(first + 2u * uint(child) + 1u);
        u = u < 0.99999994f ? u : 0.99999994f; // quotients round up to 1
        float left = child_importance(node.y, lit);
        float right = child_importance(node.z, lit);
        precise float both = left + right;
        if (!(both > 0.0f)) {
            c.probability = 0.0f;
            return c;
        }
        precise float share = left / both;
        if (u < share) {
            precise float within = u / share;
            u = within;
            precise float probability = c.probability * share;
            c.probability = probability;
            child = node.y;
        } else {
            precise float rest = right / both;
            precise float within = (u - share) / rest;
            u = within;
            precise float probability = c.probability * rest;
            c.probability = probability;
            child = node.z;
        }
    }
    c.number = light_of_child(child);
    return c;
}

// For u from 0 to 1.
ChosenLight chosen_light(LitPoint lit, float u)
{
    Table lights = table_of(scene(LIGHT_TABLE));
    vec4 tree = scene(LIGHT_TREE);
    uint placed = uint(tree.w); // lights that have a place come first
    float root = tree.y > 0.0f ? 0.0f : -1.0f;
    float in_tree = placed > 0u ? child_importance(root, lit) : 0.0f;
    float total = in_tree;
    for (uint n = placed; n < lights.count; ++n) {
        precise float more = total + light_importance(light_at(n), lit);
        total = more;
    }
    ChosenLight c;
    c.number = 0u;
    c.probability = 0.0f;
    if (!(total > 0.0f))
        return c;
    precise float goal = u * total;
    if (goal < in_tree) {
        precise float within = goal / in_tree;
        c = light_in_tree(root, lit, within);
        precise float probability = c.probability * (in_tree / total);
        c.probability = probability;
        return c;
    }
    float below = in_tree;
    bool found = false;
    for (uint n = placed; n < lights.count && !found; ++n) {
        float importance = light_importance(light_at(n), lit);
        precise float past = below + importance;
        if (importance > 0.0f) {
            c.number = n; // the last one that gives light, if rounding leaves the goal above the sum
            precise float share = importance / total;
            c.probability = share;
            found = goal < past;
        }
        below = past;
    }
    return c;
}
