// Counts a state down to 0: for as many passes as that takes, all other elements wait.
#include <photongrid/core/none.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
STATE(0, vec4, left)

bool done()
{
    return !(left.x > 0.0f);
}

void kernel(uint i)
{
    left.x -= 1.0f;
}
