// Copies pairs and fills up with the largest pair there is, for sorting any n with a network for powers of two. A pair of
// the user's that equals the filling is the same bits, so none can be lost.
struct Params {
    uint pairs; // how many there are
};
PARAMS(Params)
INPUT(0, uvec2, pairs)
OUTPUT(0, uvec2, pair)

void kernel(uint i)
{
    pair = uvec2(0xFFFFFFFFu, 0xFFFFFFFFu);
    if (i < args.pairs)
        pair = pairs(i);
}
