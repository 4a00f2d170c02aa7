// Each element from itself and from a far one, so that a pass depends on all of the pass before it.
struct Params {
    uint elements;
    uint stride;
};
PARAMS(Params)
INPUT(0, uint, before)
OUTPUT(0, uint, after)

void kernel(uint i)
{
    after = before(i) * 3u + before((i + args.stride) % args.elements) + 1u;
}
