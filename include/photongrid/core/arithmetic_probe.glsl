// Quotients and square roots of pseudo-random numbers, for the self-test of whether a device rounds them correctly.
#include <photongrid/core/random.glsl>

struct Params {
    uint seed;
};
PARAMS(Params)
OUTPUT(0, vec4, result) // dividend, divisor, quotient, square root of the dividend

void kernel(uint i)
{
    vec4 u = random4(uvec4(i, 0u, 0u, args.seed));
    // Mantissas over the whole interval. In one half, the operands are from 2^-7 to 2^8, as most are; in the other,
    // from 2^-61 to 2^62, so that quotients are of all sizes that need no subnormal number.
    float binades = (i & 1u) == 0u ? 15.0f : 123.0f;
    precise float a = (1.0f + u.x) * uintBitsToFloat(uint(127.0f + (u.y - 0.5f) * binades) << 23u);
    precise float b = (1.0f + u.z) * uintBitsToFloat(uint(127.0f + (u.w - 0.5f) * binades) << 23u);
    precise float quotient = a / b;
    precise float root = sqrt(a);
    result = vec4(a, b, quotient, root);
}
