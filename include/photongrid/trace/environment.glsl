// The light of the environment (scene/distant_lights.hpp). Included by kernels after the INPUT
// environment: of each texel rgb, W/(m^2 sr), and w: the density of sampled directions times the sine of the
// colatitude, sr^-1. Record: at + 1: columns, rows; at + 4: quaternion from the map's directions to the scene's.

// v turned by a quaternion.
vec3 turned_by(vec4 q, vec3 v)
{
    precise vec3 once = cross3(vec3(q), v) + v * q.w;
    vec3 half_way = cross3(vec3(q), once);
    precise vec3 turned = v + (half_way + half_way);
    return turned;
}

uint environment_texel(uint at, uint column, uint row)
{
    return row * uint(scene(at + 1u).x) + column;
}

// What comes from direction d.
struct EnvironmentSeen {
    vec3 radiance; // W/(m^2 sr)
    float density; // of sampled directions, sr^-1
};

EnvironmentSeen environment_seen(uint at, vec3 d)
{
    vec4 size = scene(at + 1u);
    vec4 turn = scene(at + 4u);
    vec3 m = turned_by(vec4(-turn.x, -turn.y, -turn.z, turn.w), d);
    precise float across = sqrt(m.x * m.x + m.z * m.z);
    float half_turn = across > 0.0f ? angle_of(abs(m.x), -m.z) : 0.0f;
    precise float u = (m.x < 0.0f ? 6.28318531f - half_turn : half_turn) * 0.159154943f * size.x;
    precise float v = angle_of(across, m.y) * 0.318309886f * size.y;
    uint column = min(uint(u), uint(size.x) - 1u);
    uint row = min(uint(v), uint(size.y) - 1u);
    vec4 texel = environment(environment_texel(at, column, row));
    EnvironmentSeen s;
    s.radiance = vec3(texel);
    precise float density = across > 0.0f ? texel.w / across : 0.0f;
    s.density = density;
    return s;
}
