// A kernel with a mistake on line 14, for the tests that ask each compiler where it is.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uvec2, pairs)
OUTPUT(0, uint, value)

void kernel(uint i)
{
    uvec2 pair = pairs(i);
    value = 0u;
    if (i > 1u)
        value = pair.w;
}
