// Lights at a point (scene/lights.hpp). Records: at + 1: position. Samples: trace/light_sample.glsl.
SWITCH(6, POINT_LIGHTS)
const uint POINT_LIGHT = 6u;

Emitted point_emit(uint at, Emitted e, vec4 r)
{
    e.origin = vec3(scene(at + 1u));
    e.direction = uniform_direction(r.x, r.y);
    return e;
}

float point_importance(uint at, float watts, LitPoint lit)
{
    return ball_importance(vec3(scene(at + 1u)), 0.0f, watts, lit);
}
