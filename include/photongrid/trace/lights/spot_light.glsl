// Spotlights (scene/spot_light.hpp). Records: at + 1: position; at + 2: unit vector of the axis; w: greatest intensity
// divided by the power, sr^-1; at + 3: 1 - cosine of the inner angle; that of the outer angle less that of the inner
// one; share of the power within the inner angle.
SWITCH(13, SPOT_LIGHTS)
const uint SPOT_LIGHT = 13u;

// The intensity in direction d, divided by the power, sr^-1.
float spot_intensity(uint at, vec3 d)
{
    vec4 axis = scene(at + 2u);
    vec4 cone = scene(at + 3u);
    // 1 - the cosine of the angle of two unit vectors is half the square of their distance.
    precise vec3 apart = d - vec3(axis);
    precise float beyond = 0.5f * dot3(apart, apart) - cone.x;
    if (beyond <= 0.0f)
        return axis.w;
    if (!(beyond < cone.y))
        return 0.0f;
    precise float t = 1.0f - beyond / cone.y;
    precise float intensity = axis.w * t * t * (3.0f - 2.0f * t);
    return intensity;
}

// A direction with a density in proportion to the intensity, for numbers from 0 to 1.
vec3 spot_direction(uint at, float part, float u, float turn, vec3 three)
{
    vec4 cone = scene(at + 3u);
    precise float below = cone.x * u; // 1 - cosine
    if (!(part < cone.z)) {
        // u is taken if the median of three numbers is at most u, with probability 3 u^2 - 2 u^3. Otherwise 1 - u is
        // taken, which has the same density, so no number is rejected.
        float median = max(min(three.x, three.y), min(max(three.x, three.y), three.z));
        float t = median > u ? 1.0f - u : u;
        precise float outside = cone.x + cone.y * (1.0f - t);
        below = outside;
    }
    precise float sine = sqrt(below * (2.0f - below));
    vec2 circle = unit_circle(turn);
    return from_basis(vec3(sine * circle.x, sine * circle.y, 1.0f - below), vec3(scene(at + 2u)));
}

Emitted spot_emit(uint at, Emitted e, vec4 r, vec4 s)
{
    e.origin = vec3(scene(at + 1u));
    e.direction = spot_direction(at, s.y, r.x, r.y, vec3(r.z, r.w, s.z));
    return e;
}

ArrivingLight spot_sample(uint at, ArrivingLight a, LitPoint lit)
{
    vec3 from = vec3(scene(at + 1u));
    LightWay way = way_to(from, lit);
    float intensity = spot_intensity(at, -way.direction);
    if (!(way.distance2 > 0.0f) || !(way.cosine > 0.0f) || !(intensity > 0.0f))
        return a;
    float least2 = lit.offset * lit.offset; // as for a point light
    precise float per_power = way.cosine * intensity / (way.distance2 > least2 ? way.distance2 : least2);
    a.found = lit_from(from, per_power, lit);
    precise float short_of = a.found.far * 0.9999f; // it may touch a surface
    a.found.far = short_of;
    return a;
}

float spot_importance(uint at, float watts, LitPoint lit)
{
    vec3 from = vec3(scene(at + 1u));
    vec3 to = from - lit.position;
    precise vec3 way = -to / sqrt(dot3(to, to));
    precise float aimed = ball_importance(from, 0.0f, watts, lit) * spot_intensity(at, way) * 12.5663706f;
    return aimed > 0.0f ? aimed : 0.0f;
}
