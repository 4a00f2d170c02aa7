// Stable radix sort, step 1 of 3: counts each of 16 digits in each chunk of consecutive keys, with one invocation per
// chunk. Counters are ordered by digit, so that their prefix sums are the destinations of a chunk's keys with that
// digit.
struct Params {
    uint keys;
    uint shift;  // of the digit
    uint chunk;  // keys per chunk
    uint chunks;
};
PARAMS(Params)
layout(std430, binding = 0) readonly buffer keys_block_ { uvec2 keys_[]; };
layout(std430, binding = 1) buffer counters_block_ { uint counters_[]; };

void main()
{
    uint c = element_();
    if (c >= args.chunks)
        return;
    for (uint d = 0u; d < 16u; ++d)
        counters_[d * args.chunks + c] = 0u;
    uint end = min((c + 1u) * args.chunk, args.keys);
    for (uint i = c * args.chunk; i < end; ++i)
        counters_[((keys_[i].x >> args.shift) & 15u) * args.chunks + c] += 1u;
}
