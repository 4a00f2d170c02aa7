// Light in one direction (scene/distant_lights.hpp). Records besides those of trace/lights/distant_light.glsl: at + 1:
// unit vector of the light's direction; w: irradiance divided by the power.
SWITCH(14, DIRECTIONAL_LIGHTS)
const uint DIRECTIONAL_LIGHT = 14u;

Emitted directional_emit(uint at, Emitted e, vec4 r)
{
    e.direction = vec3(scene(at + 1u));
    e.origin = entry_point(at, e.direction, r.y, r.z, r.w);
    return e;
}

ArrivingLight directional_sample(uint at, ArrivingLight a, LitPoint lit)
{
    vec4 light = scene(at + 1u);
    a.found = distant_sample(-vec3(light), light.w, lit);
    return a;
}

float directional_importance(uint at, float watts, LitPoint lit)
{
    vec4 light = scene(at + 1u);
    precise float facing = -dot3(vec3(light), lit.normal) * light.w * watts;
    return facing > 0.0f ? facing : 0.0f;
}
