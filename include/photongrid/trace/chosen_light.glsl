// A light that is chosen for a sample, where there are many: by an estimate of its irradiance without shadows. Included
// by kernels after trace/light_sample.glsl, trace/mesh_light.glsl, trace/spot_light.glsl and trace/distant_light.glsl.

// The estimate: 0 only where the light gives none, else anything above 0. `at`: the light's record.
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
    // Of others: a ball that holds the light.
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
    precise vec3 to = middle - lit.position;
    precise float least = radius + lit.offset;
    precise float distance2 = dot3(to, to) + least * least;
    float distance = sqrt(distance2);
    precise float cosine = (dot3(to, lit.normal) + least) / distance; // of the ball's highest point, at least
    precise float falling = (cosine < 1.0f ? cosine : 1.0f) * watts / distance2 * 7.95774715e-2f;
    if (SPOT_LIGHTS && form == SPOT_LIGHT) {
        precise vec3 way = -to / sqrt(dot3(to, to));
        precise float aimed = falling * spot_intensity(at, way) * 12.5663706f;
        falling = aimed;
    }
    return falling > 0.0f ? falling : 0.0f;
}

struct ChosenLight {
    uint number;
    float probability; // 0: none gives any light
};

// For u from 0 to 1.
ChosenLight chosen_light(LitPoint lit, float u)
{
    Table lights = table_of(scene(LIGHT_TABLE));
    float total = 0.0f;
    for (uint n = 0u; n < lights.count; ++n) {
        precise float more = total + light_importance(lights.first + lights.stride * n, lit);
        total = more;
    }
    ChosenLight c;
    c.number = 0u;
    c.probability = 0.0f;
    if (!(total > 0.0f))
        return c;
    precise float goal = u * total;
    float below = 0.0f;
    bool found = false;
    for (uint n = 0u; n < lights.count && !found; ++n) {
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
