// Lights, read from the scene buffer. Included by kernels after it. The first record of a light, `at`, has its kind,
// the probability that a path starts on it, that it starts on it or on one before it, and how samples of it differ. Of
// the last one, at + 5, xyz is the power, W; w: see media_around(). Those between are the kind's own (trace/lights/).
// Of kinds that rays can hit, w of at + 1 is 1 / (pi area), m^-2 sr^-1; of SAMPLED_BY_SOLID_ANGLE at + 1 is the ball's
// centre, x of at + 2 its radius.

uint light_at(uint number)
{
    Table table = table_of(scene(LIGHT_TABLE));
    return table.first + table.stride * number;
}

// The number of its SWITCH.
uint kind_of_light(uint at)
{
    return uint(scene(at).x);
}

vec3 light_power(uint at)
{
    return vec3(scene(at + 5u));
}

// The media that it stands in (trace/media.glsl).
uint media_around(uint at)
{
    return uint(scene(at + 5u).w);
}

// Of kinds that rays can hit: their radiance divided by their power.
float radiance_per_power(uint at)
{
    return scene(at + 1u).w;
}

// The density of the samples' directions at a point `far` away, whose ray in direction d hits the light, sr^-1.
float light_density(uint at, vec3 from, float far, vec3 d, vec3 normal)
{
    if (scene(at).w == float(SAMPLED_BY_SOLID_ANGLE)) {
        float radius = scene(at + 2u).x;
        precise vec3 to_centre = vec3(scene(at + 1u)) - from;
        precise float sine2 = radius * radius / dot3(to_centre, to_centre);
        if (!(sine2 < 1.0f))
            return 0.0f;
        precise float density = (1.0f + sqrt(1.0f - sine2)) / (6.28318531f * sine2);
        return density;
    }
    precise float density = far * far * 3.14159265f * radiance_per_power(at) / -dot3(d, normal);
    return density;
}

// The scene's environment, its last light.
uint environment_light()
{
    return light_at(table_of(scene(LIGHT_TABLE)).count - 1u);
}

// Probabilities, in proportion to power: that this light is chosen; that this light or one before it is.
float light_probability(uint at)
{
    return scene(at).y;
}
float cumulative_probability(uint at)
{
    return scene(at).z;
}
