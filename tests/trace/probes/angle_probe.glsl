// The angle between two lengths, a logarithm and a power of e, for tests.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/natural_exp.glsl>
#include <photongrid/core/natural_log.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, numbers) // y >= 0, x; a number from 1 on; one from 0 on
OUTPUT(0, vec4, values) // angle, logarithm, e to the power of minus the last

void kernel(uint i)
{
    vec4 n = numbers(i);
    values = vec4(angle_of(n.x, n.y), natural_log(n.z), exp_of_minus(n.w), 0.0f);
}
