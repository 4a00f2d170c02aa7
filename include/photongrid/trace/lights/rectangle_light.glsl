// Rectangles that are lights (scene/lights.hpp). Records: at + 1: a corner; at + 2 and at + 3: edges; at + 4: unit
// normal; light leaves on this side. Samples: trace/light_sample.glsl.
SWITCH(7, AREA_LIGHTS)
const uint RECTANGLE_LIGHT = 7u;

Emitted rectangle_emit(uint at, Emitted e, vec4 r)
{
    vec3 corner = vec3(scene(at + 1u));
    vec3 edge_u = vec3(scene(at + 2u));
    vec3 edge_v = vec3(scene(at + 3u));
    vec3 normal = vec3(scene(at + 4u));
    // The rounding error depends on the terms, which may be larger than their sum.
    float off = ray_offset(abs(corner) + abs(edge_u) + abs(edge_v), scene(SCENE_SIZES).x);
    e.direction = cosine_direction(normal, r.x, r.y);
    e.origin = ray_at(ray_at(ray_at(corner, edge_u, r.z), edge_v, r.w), normal, off);
    return e;
}

float rectangle_importance(uint at, float watts, LitPoint lit)
{
    vec3 u = vec3(scene(at + 2u));
    vec3 v = vec3(scene(at + 3u));
    vec3 middle = ray_at(ray_at(vec3(scene(at + 1u)), u, 0.5f), v, 0.5f);
    precise float half_diagonal = 0.5f * sqrt(dot3(u, u) + dot3(v, v));
    precise vec3 from_lamp = lit.position - middle;
    float off = ray_offset(abs(middle) + abs(u) + abs(v), lit.round_share);
    if (dot3(from_lamp, vec3(scene(at + 4u))) < -off)
        return 0.0f; // behind it
    return ball_importance(middle, half_diagonal, watts, lit);
}
