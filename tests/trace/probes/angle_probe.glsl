// The angle between two lengths, and a logarithm, for tests.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/natural_log.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, numbers) // y >= 0, x; a number from 1 on
OUTPUT(0, vec2, values) // angle, logarithm

void kernel(uint i)
{
    vec4 n = numbers(i);
    values = vec2(angle_of(n.x, n.y), natural_log(n.z));
}
