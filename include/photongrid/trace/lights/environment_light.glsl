// The environment as a light (scene/distant_lights.hpp). Included by kernels after trace/environment.glsl and the INPUT
// environment_shares: of each row, then of each texel of each row, the share of the light, times 2^24, that is in it
// and in those before it.
SWITCH(15, ENVIRONMENT_LIGHTS)
const uint ENVIRONMENT_LIGHT = 15u;

// The first of `count` elements from `first` on whose share is above a number from 0 to 1, counted from `first`.
uint chosen_share(uint first, uint count, float u)
{
    uint goal = uint(u * 16777216.0f);
    uint low = first;
    uint high = first + count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (environment_shares(middle) > goal)
            high = middle;
        else
            low = middle + 1u;
    }
    return low - first;
}

struct EnvironmentSample {
    vec3 towards;             // unit vector in the scene
    vec3 radiance_per_density; // W/m^2
    float density;             // sr^-1
};

// Of numbers from 0 to 1, `place` chooses a texel, `inside` a point of it.
EnvironmentSample environment_sample(uint at, vec2 place, vec2 inside)
{
    vec4 size = scene(at + 1u);
    uint columns = uint(size.x);
    uint rows = uint(size.y);
    uint row = chosen_share(0u, rows, place.y);
    uint column = chosen_share(rows + row * columns, columns, place.x);
    vec4 texel = environment(environment_texel(at, column, row));
    precise float u = (float(column) + inside.x) / size.x;
    precise float half_v = (float(row) + inside.y) / size.y * 0.5f;
    vec2 longitude = unit_circle(u);
    vec2 colatitude = unit_circle(half_v);
    float sine = colatitude.y > 0.0f ? colatitude.y : 0.0f;
    EnvironmentSample s;
    precise vec3 m = vec3(longitude.y * sine, colatitude.x, -longitude.x * sine);
    s.towards = normalized3(turned_by(scene(at + 4u), m));
    precise float scale = sine / texel.w;
    precise vec3 weighted = vec3(texel) * scale;
    s.radiance_per_density = weighted;
    precise float density = texel.w / sine;
    s.density = density;
    return s;
}

// `probability`: of this light.
Emitted environment_emit(uint at, Emitted e, vec4 r, vec4 s, float probability)
{
    EnvironmentSample from = environment_sample(at, vec2(s.y, s.z), vec2(s.w, r.x));
    e.direction = -from.towards;
    precise vec3 entering = from.radiance_per_density * (outline_area(at, e.direction) / probability);
    e.power = entering;
    e.origin = entry_point(at, e.direction, r.y, r.z, r.w);
    return e;
}

ArrivingLight environment_arriving(uint at, ArrivingLight a, SampleNumbers n, LitPoint lit)
{
    EnvironmentSample e = environment_sample(at, n.place, vec2(n.r.z, n.r.w));
    a.found = distant_sample(e.towards, n.share, lit);
    a.power = e.radiance_per_density;
    a.radiance_per_power = e.density;
    return a;
}

float environment_importance(uint at, float watts)
{
    // The irradiance of an even sky. A convex body's outline is a quarter of its surface, on average over all
    // directions, so that its power is that irradiance times the surface of the box.
    precise vec3 size = vec3(scene(at + 3u)) - vec3(scene(at + 2u));
    precise float even = 0.5f * watts / (size.x * size.y + size.y * size.z + size.z * size.x);
    return even;
}
