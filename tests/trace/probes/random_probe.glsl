// The hash and the numbers made of it, for tests.
#include <photongrid/core/random.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uvec4, keys)
OUTPUT(0, uvec4, hash)
OUTPUT(1, vec4, number) // of the hash
OUTPUT(2, float, unit)  // of the key's x as it is

void kernel(uint i)
{
    hash = hash4(keys(i));
    number = random4(keys(i));
    unit = unit_float(keys(i).x);
}
