// Stable radix sort, step 3 of 3: moves every key to its destination. One invocation processes a chunk in order, so
// keys with equal digits keep their order.
struct Params {
    uint keys;
    uint shift;
    uint chunk;
    uint chunks;
};
PARAMS(Params)
layout(std430, binding = 0) readonly buffer keys_block_ { uvec2 keys_[]; };
layout(std430, binding = 1) buffer counters_block_ { uint counters_[]; };
layout(std430, binding = 2) buffer sorted_block_ { uvec2 sorted_[]; };

void main()
{
    uint c = element_();
    if (c >= args.chunks)
        return;
    uint end = min((c + 1u) * args.chunk, args.keys);
    for (uint i = c * args.chunk; i < end; ++i) {
        uvec2 key = keys_[i];
        uint counter = ((key.x >> args.shift) & 15u) * args.chunks + c;
        uint to = counters_[counter];
        counters_[counter] = to + 1u;
        sorted_[to] = key;
    }
}
