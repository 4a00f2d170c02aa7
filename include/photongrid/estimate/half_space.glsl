// The half space before a plane at right angles to a surface, such as that of a wall which stands on it. It is one
// number, so that a point can have it in the w of its normal: 0: all space; else 1 and 24 bits: the direction to the
// plane (12) and its distance over the radius (12), which round to 0.1 degrees and 0.0002 radii. The plane may lie
// within a radius alone. Included by kernels after core/vector.glsl.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

struct HalfSpace {
    vec3 way;  // unit vector to the plane, along the surface
    float far; // distance of the plane, m
};

// n: unit normal of the surface; way: along the surface to the plane, not 0; share: its distance over the radius.
inline float half_space_code(vec3 n, vec3 way, float share)
{
    vec3 v = in_basis(way, n);
    // The angle as a way round the square |x| + |y| = 1 of length 4: trigonometric functions differ between devices.
    precise float rise = v.y / (abs(v.x) + abs(v.y));
    precise float turn = v.x < 0.0f ? 2.0f - rise : (rise < 0.0f ? 4.0f + rise : rise);
    uint direction = uint(turn * 1024.0f + 0.5f) % 4096u;
    uint distance = uint((share > 0.0f ? (share < 1.0f ? share : 1.0f) : 0.0f) * 4095.0f + 0.5f);
    return float(direction * 4096u + distance + 1u);
}

// n: unit normal; w: the code.
inline HalfSpace half_space_of(vec4 n, float radius)
{
    HalfSpace h;
    h.way = vec3(0.0f, 0.0f, 0.0f);
    h.far = 3.0e38f;
    if (!(n.w > 0.0f))
        return h;
    uint code = uint(n.w) - 1u;
    float turn = float(code / 4096u) * 0.0009765625f;
    float x = turn < 2.0f ? 1.0f - turn : turn - 3.0f;
    float y = turn < 1.0f ? turn : (turn < 3.0f ? 2.0f - turn : turn - 4.0f);
    precise float length = sqrt(x * x + y * y);
    precise vec3 along = vec3(x / length, y / length, 0.0f);
    precise float far = float(code % 4096u) * 0.0002442002f * radius;
    h.way = from_basis(along, vec3(n));
    h.far = far;
    return h;
}

// Whether what lies there from the point, m, is beyond the plane.
inline bool is_beyond(HalfSpace h, float dx, float dy, float dz)
{
    precise float along = dx * h.way.x + dy * h.way.y + dz * h.way.z;
    return !(along <= h.far);
}

#endif
