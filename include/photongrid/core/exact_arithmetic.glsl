// Correctly rounded quotients and square roots for devices whose own may be off by a few units in the last place.
// with_exact_arithmetic() (exact_arithmetic.hpp) replaces `a / b` and `sqrt(x)` in kernels by these functions. They
// need a fused fma. Outside of 2^-79 to 2^100, where residuals would lose bits or overflow, they take the operands'
// powers of two out first. Subnormal operands and quotients, infinities and NaNs are left to the device.
inline bool has_exact_residuals(float least, float most)
{
    return least >= 1.6543612e-24f && most <= 1.2676506e30f;
}

// a / b, from an approximate 1 / b: of the two numbers about the quotient, the one with the smaller residual. fma
// computes residuals exactly (Markstein, Computation of elementary functions on the IBM RISC System/6000 processor, IBM
// J. Res. Dev. 34(1), 1990). His own last step needs a correctly rounded reciprocal, which one step does not always
// give.
inline float refined_quotient(float a, float b, float reciprocal)
{
    precise float rough = a * reciprocal;
    precise float quotient = fma(fma(-rough, b, a), reciprocal, rough);
    precise float residual = fma(-quotient, b, a);
    bool farther = (residual > 0.0f) == (a > 0.0f); // from 0 than `quotient`
    float neighbour = uintBitsToFloat(floatBitsToUint(quotient) + (farther ? 1u : 0xFFFFFFFFu));
    precise float its_residual = fma(-neighbour, b, a);
    return abs(its_residual) < abs(residual) ? neighbour : quotient;
}

// The square root of x, from an approximate one. A step of Newton's iteration does not end below the root, so that it
// is the right number or the one above that: x lies between the products of the right one with its two neighbours
// (Tuckerman's test; Markstein, as above).
inline float refined_root(float x, float approximate)
{
    precise float root = fma(fma(-approximate, approximate, x), 0.5f / approximate, approximate);
    float below = uintBitsToFloat(floatBitsToUint(root) - 1u);
    precise float over = fma(-root, below, x);
    return over <= 0.0f ? below : root;
}

inline uint exponent_of(float x) { return floatBitsToUint(x) >> 23u & 255u; }
// 2^e, and 0 below 2^-126.
inline float power_of_2(int e) { return uintBitsToFloat(uint(max(e + 127, 0)) << 23u); }
// x with its sign, times a power of two that moves its size to 1 and below 2.
inline float mantissa_of(float x) { return uintBitsToFloat((floatBitsToUint(x) & 0x807FFFFFu) | 0x3F800000u); }

// a / b of any size. `rounded_loosely` where a, b or a / b is 0, subnormal, infinite or NaN.
inline float scaled_quotient(float a, float b, float rounded_loosely)
{
    uint of_a = exponent_of(a), of_b = exponent_of(b);
    if (min(of_a, of_b) == 0u || max(of_a, of_b) == 255u)
        return rounded_loosely;
    float divisor = mantissa_of(b);
    float quotient = refined_quotient(mantissa_of(a), divisor, 1.0f / divisor);
    int power = int(of_a) - int(of_b);
    int half_of_it = power / 2; // 2^power may be too large or small for a number
    precise float sized = quotient * power_of_2(half_of_it) * power_of_2(power - half_of_it);
    uint of_it = exponent_of(sized);
    return of_it == 0u || of_it == 255u ? rounded_loosely : sized;
}

// The square root of x of any size; `rounded_loosely` where x is 0, subnormal, infinite or NaN.
inline float scaled_root(float x, float rounded_loosely)
{
    uint exponent = exponent_of(x);
    if (exponent == 0u || exponent == 255u || x < 0.0f)
        return rounded_loosely;
    int power = int(exponent) - 127;
    int half_of_it = power >> 1; // rounds down
    float part = mantissa_of(x) * (power - 2 * half_of_it == 1 ? 2.0f : 1.0f);
    precise float root = refined_root(part, sqrt(part)) * power_of_2(half_of_it);
    return root;
}

inline float exact_quotient(float a, float b)
{
    float size_a = abs(a), size_b = abs(b);
    precise float quotient = refined_quotient(a, b, 1.0f / b);
    float size = abs(quotient);
    if (!has_exact_residuals(min(min(size_a, size_b), size), max(max(size_a, size_b), size)))
        return scaled_quotient(a, b, a / b);
    return quotient;
}

inline float exact_root(float x)
{
    return has_exact_residuals(x, x) ? refined_root(x, sqrt(x)) : scaled_root(x, sqrt(x));
}

inline vec2 exact_quotient(vec2 a, vec2 b) { return vec2(exact_quotient(a.x, b.x), exact_quotient(a.y, b.y)); }
inline vec3 exact_quotient(vec3 a, vec3 b)
{
    return vec3(exact_quotient(a.x, b.x), exact_quotient(a.y, b.y), exact_quotient(a.z, b.z));
}
inline vec4 exact_quotient(vec4 a, vec4 b)
{
    return vec4(
        exact_quotient(a.x, b.x), exact_quotient(a.y, b.y), exact_quotient(a.z, b.z), exact_quotient(a.w, b.w));
}
inline vec2 exact_quotient(vec2 a, float b) { return exact_quotient(a, vec2(b, b)); }
inline vec3 exact_quotient(vec3 a, float b) { return exact_quotient(a, vec3(b, b, b)); }
inline vec4 exact_quotient(vec4 a, float b) { return exact_quotient(a, vec4(b, b, b, b)); }
inline vec2 exact_quotient(float a, vec2 b) { return exact_quotient(vec2(a, a), b); }
inline vec3 exact_quotient(float a, vec3 b) { return exact_quotient(vec3(a, a, a), b); }
inline vec4 exact_quotient(float a, vec4 b) { return exact_quotient(vec4(a, a, a, a), b); }
inline vec2 exact_root(vec2 x) { return vec2(exact_root(x.x), exact_root(x.y)); }
inline vec3 exact_root(vec3 x) { return vec3(exact_root(x.x), exact_root(x.y), exact_root(x.z)); }
inline vec4 exact_root(vec4 x)
{
    return vec4(exact_root(x.x), exact_root(x.y), exact_root(x.z), exact_root(x.w));
}

// Integers divide exactly everywhere.
inline int exact_quotient(int a, int b) { return a / b; }
inline uint exact_quotient(uint a, uint b) { return a / b; }
inline ivec2 exact_quotient(ivec2 a, ivec2 b) { return a / b; }
inline ivec3 exact_quotient(ivec3 a, ivec3 b) { return a / b; }
inline ivec4 exact_quotient(ivec4 a, ivec4 b) { return a / b; }
inline uvec2 exact_quotient(uvec2 a, uvec2 b) { return a / b; }
inline uvec3 exact_quotient(uvec3 a, uvec3 b) { return a / b; }
inline uvec4 exact_quotient(uvec4 a, uvec4 b) { return a / b; }
inline ivec2 exact_quotient(ivec2 a, int b) { return a / b; }
inline ivec3 exact_quotient(ivec3 a, int b) { return a / b; }
inline ivec4 exact_quotient(ivec4 a, int b) { return a / b; }
inline uvec2 exact_quotient(uvec2 a, uint b) { return a / b; }
inline uvec3 exact_quotient(uvec3 a, uint b) { return a / b; }
inline uvec4 exact_quotient(uvec4 a, uint b) { return a / b; }
