// Directions from which the environment's light comes. Included by kernels after trace/environment.glsl and the INPUT
// environment_shares: of each row, then of each texel of each row, the share of the light, times 2^24, that is in it
// and in those before it.

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
