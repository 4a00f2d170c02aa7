// Chooses a light for a sample, where there are many: down a tree of lights, from its root on, by estimates of each
// half's irradiance without shadows (Conty Estevez and Kulla, Importance Sampling of Many Lights with Adaptive Tree
// Splitting, 2018). Lights from outside of the scene are not in the tree: each is estimated. Included by kernels after
// trace/light_sample.glsl, trace/mesh_light.glsl, trace/spot_light.glsl and trace/distant_light.glsl.

// The estimate for lamps of this power inside a ball: 0 only where none of the ball can be seen from the lit side.
float ball_importance(vec3 middle, float radius, float watts, LitPoint lit)
{
    precise vec3 to = middle - lit.position;
    precise float least = radius + lit.offset;
    precise float distance2 = dot3(to, to) + least * least;
    float distance = sqrt(distance2);
    precise float cosine = (dot3(to, lit.normal) + least) / distance; // of the ball's highest point, at least
    precise float falling = (cosine < 1.0f ? cosine : 1.0f) * watts / distance2 * 7.95774715e-2f;
    return falling > 0.0f ? falling : 0.0f;
}

// The estimate for one light: 0 only where it gives none. `at`: the light's record.
float light_importance(uint at, LitPoint lit)
{
    uint form = uint(scene(at).x);
    vec4 first = scene(at + 1u);
    vec4 power = scene(at + 5u);
    precise float watts = power.x + power.y + power.z;
    if (DIRECTIONAL_LIGHTS && form == DIRECTIONAL_LIGHT) {
        precise float facing = -dot3(vec3(first), lit.normal) * first.w * watts;
        return facing > 0.0f ? facing : 0.0f;
    }
    if (ENVIRONMENT_LIGHTS && form == ENVIRONMENT_LIGHT) {
        // A convex body's outline is a quarter of its surface, on average over all directions.
        precise vec3 size = vec3(scene(at + 3u)) - vec3(scene(at + 2u));
        precise float even = 2.0f * watts / (size.x * size.y + size.y * size.z + size.z * size.x);
        return even;
    }
    vec3 middle = vec3(first);
    float radius = 0.0f;
    if (form == RECTANGLE_LIGHT) {
        vec3 u = vec3(scene(at + 2u));
        vec3 v = vec3(scene(at + 3u));
        middle = ray_at(ray_at(middle, u, 0.5f), v, 0.5f);
        precise float half_diagonal = 0.5f * sqrt(dot3(u, u) + dot3(v, v));
        radius = half_diagonal;
        precise vec3 from_lamp = lit.position - middle;
        float off = ray_offset(abs(middle) + abs(u) + abs(v), lit.round_share);
        if (dot3(from_lamp, vec3(scene(at + 4u))) < -off)
            return 0.0f; // behind it
    }
    if (SPHERE_LIGHTS && form == SPHERE_LIGHT)
        radius = scene(at + 2u).x;
    if (MESH_LIGHTS && form == MESH_LIGHT)
        radius = scene(at + 4u).x;
    float falling = ball_importance(middle, radius, watts, lit);
    if (SPOT_LIGHTS && form == SPOT_LIGHT) {
        vec3 to = middle - lit.position;
        precise vec3 way = -to / sqrt(dot3(to, to));
        precise float aimed = falling * spot_intensity(at, way) * 12.5663706f;
        falling = aimed > 0.0f ? aimed : 0.0f;
    }
    return falling;
}

// A child of a node (trace/light_tree.hpp): a node, or below 0 a light.
uint light_of_child(float child)
{
    return uint(-1.0f - child);
}
float child_importance(float child, LitPoint lit)
{
    if (child < 0.0f) {
        Table lights = table_of(scene(LIGHT_TABLE));
        return light_importance(lights.first + lights.stride * light_of_child(child), lit);
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
        precise float more = total + light_importance(lights.first + lights.stride * n, lit);
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
        float importance = light_importance(lights.first + lights.stride * n, lit);
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
