// Copies pairs and pads them with the largest possible pair, so that a network for powers of two can sort any number. A
// user's pair that equals the padding has the same bits, so no pair can be lost.
struct Params {
    uint pairs; // number of pairs
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
