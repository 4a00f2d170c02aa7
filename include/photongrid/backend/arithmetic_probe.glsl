// Quotients and square roots of pseudo-random numbers, for the self-test of whether a device rounds them correctly.
#include <photongrid/backend/random.glsl>

struct Params {
    uint seed;
};
PARAMS(Params)
OUTPUT(0, vec4, result) // dividend, divisor, quotient, square root of the dividend

void kernel(uint i)
{
    vec4 u = random4(uvec4(i, 0u, 0u, args.seed));
    // Mantissas over the whole interval; magnitudes of the operands over fifteen binades, of the quotients over thirty.
    precise float a = (1.0f + u.x) * float(1u << uint(u.y * 15.0f)) * 0.0078125f;
    precise float b = (1.0f + u.z) * float(1u << uint(u.w * 15.0f)) * 0.0078125f;
    precise float quotient = a / b;
    precise float root = sqrt(a);
    result = vec4(a, b, quotient, root);
}
