// Points of sequences, for tests.
#include <photongrid/core/random.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uvec4, keys)
INPUT(1, uint, nths)
OUTPUT(0, vec4, four)
OUTPUT(1, vec4, two)

void kernel(uint i)
{
    four = sequence4(nths(i), keys(i));
    vec2 pair = sequence2(nths(i), keys(i));
    two = vec4(pair.x, pair.y, 0.0f, 0.0f);
}
