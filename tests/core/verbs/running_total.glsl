// A state in place, and beside it what it was.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uint, added)
STATE(0, uvec2, total)
OUTPUT(1, uint, old)

void kernel(uint i)
{
    old = total.x;
    total = uvec2(total.x + added(i), total.y + 1u);
}
