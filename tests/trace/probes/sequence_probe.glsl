// Points of sequences, for tests.
#include <photongrid/backend/random.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uvec4, keys)
INPUT(1, uint, nths)
OUTPUT(0, vec4, four)
OUTPUT(1, vec2, two)

void kernel(uint i)
{
    four = sequence4(nths(i), keys(i));
    two = sequence2(nths(i), keys(i));
}
