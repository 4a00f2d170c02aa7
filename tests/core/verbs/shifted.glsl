// What stands there, plus a number and the element's own.
struct Params {
    uint added;
};
PARAMS(Params)
INPUT(0, uint, before)
OUTPUT(0, uint, after)

void kernel(uint i)
{
    after = before(i) + args.added + i;
}
