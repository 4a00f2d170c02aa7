// One part of a buffer from another part of it.
struct Params {
    uint distance;
};
PARAMS(Params)
INPUT(0, uint, below)
OUTPUT(0, uint, above)

void kernel(uint i)
{
    above = below(i - args.distance) * 2u + 1u;
}
