// Vector arithmetic, written out. GLSL's dot, length and normalize round differently on different devices; these
// functions do not.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

inline float dot3(vec3 a, vec3 b)
{
    precise float s = a.x * b.x + a.y * b.y + a.z * b.z;
    return s;
}

inline vec3 cross3(vec3 a, vec3 b)
{
    precise vec3 c = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    return c;
}

inline vec3 normalized3(vec3 v)
{
    precise float scale = 1.0f / sqrt(dot3(v, v));
    precise vec3 n = v * scale;
    return n;
}

inline vec3 ray_at(vec3 origin, vec3 direction, float t)
{
    precise vec3 p = origin + direction * t;
    return p;
}

inline float largest3(vec3 v)
{
    float m = v.x > v.y ? v.x : v.y;
    return m > v.z ? m : v.z;
}

// The first two axes of an orthonormal basis whose third axis is n. Duff et al., Building an Orthonormal Basis,
// Revisited, JCGT 6(1), 2017.
struct Basis {
    vec3 u;
    vec3 v;
};

inline Basis basis_about(vec3 n)
{
    float s = n.z >= 0.0f ? 1.0f : -1.0f;
    precise float a = -1.0f / (s + n.z);
    precise float b = n.x * n.y * a;
    precise vec3 u = vec3(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
    precise vec3 v = vec3(b, s + n.y * n.y * a, -n.y);
    Basis basis;
    basis.u = u;
    basis.v = v;
    return basis;
}

// The vector that has the coordinates `local` in that basis.
inline vec3 from_basis(vec3 local, vec3 n)
{
    Basis b = basis_about(n);
    precise vec3 w = b.u * local.x + b.v * local.y + n * local.z;
    return w;
}

// The coordinates of v in that basis.
inline vec3 in_basis(vec3 v, vec3 n)
{
    Basis b = basis_about(n);
    return vec3(dot3(v, b.u), dot3(v, b.v), dot3(v, n));
}

// (cos, sin) of 2 pi u without trigonometric functions, whose results differ between devices: the quadrant, then Taylor
// polynomials on [-pi/4, pi/4], error below 4e-7.
inline vec2 unit_circle(float u)
{
    precise float turns = u * 4.0f;
    float quadrant = floor(turns);
    precise float x = (turns - quadrant - 0.5f) * 1.57079633f;
    precise float x2 = x * x;
    precise float c = 1.0f + x2 * (-0.5f + x2 * (4.16666667e-2f + x2 * (-1.38888889e-3f + x2 * 2.48015873e-5f)));
    precise float s = x
        * (1.0f + x2 * (-1.66666667e-1f + x2 * (8.33333333e-3f + x2 * (-1.98412698e-4f + x2 * 2.75573192e-6f))));
    // x is measured from the quadrant's middle: turn by 45 degrees.
    precise float cd = (c - s) * 0.70710678f;
    precise float sd = (c + s) * 0.70710678f;
    uint q = uint(quadrant) & 3u;
    float even_x = q == 0u ? cd : -cd;
    float even_y = q == 0u ? sd : -sd;
    float odd_x = q == 1u ? -sd : sd;
    float odd_y = q == 1u ? cd : -cd;
    bool odd = (q & 1u) != 0u;
    return vec2(odd ? odd_x : even_x, odd ? odd_y : even_y);
}

// atan2(y, x) for y >= 0: a polynomial for atan(t) / t in t^2 on [0, 1], interpolated at Chebyshev's points. Its error
// is below 3e-7, rounding included.
inline float angle_of(float y, float x)
{
    float ax = abs(x);
    float larger = y > ax ? y : ax;
    precise float t = (y > ax ? ax : y) / larger;
    precise float q = t * t;
    precise float high = 0.10618370642f
        + q * (-0.07456854839f + q * (0.04213762375f + q * (-0.01573124922f + q * 0.00276628353f)));
    precise float ratio = 0.99999998179f
        + q * (-0.33333036709f + q * (0.19991872029f + q * (-0.14197797795f + q * high)));
    precise float angle = t * ratio;
    precise float acute = y > ax ? 1.57079633f - angle : angle;
    return x < 0.0f ? 3.14159265f - acute : acute;
}

// A direction in the hemisphere about n with density cos / pi.
inline vec3 cosine_direction(vec3 n, float u, float v)
{
    precise float r = sqrt(u);
    vec2 circle = unit_circle(v);
    precise float z = sqrt(1.0f - u);
    return from_basis(vec3(r * circle.x, r * circle.y, z), n);
}

// A direction with density 1 / (4 pi).
inline vec3 uniform_direction(float u, float v)
{
    precise float z = 1.0f - 2.0f * u;
    precise float r2 = 1.0f - z * z;
    precise float r = sqrt(r2 > 0.0f ? r2 : 0.0f);
    vec2 circle = unit_circle(v);
    return vec3(r * circle.x, r * circle.y, z);
}

// False for NaN and infinity. It tests the exponent's bits for the reason given at is_finite in grid.glsl.
inline bool is_finite3(vec3 p)
{
    return (floatBitsToUint(p.x) & 0x7F800000u) != 0x7F800000u && (floatBitsToUint(p.y) & 0x7F800000u) != 0x7F800000u
        && (floatBitsToUint(p.z) & 0x7F800000u) != 0x7F800000u;
}

#endif
