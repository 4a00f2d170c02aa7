// Stable radix sort, step 2 of 3: exclusive prefix sums of the counters, in one workgroup.
struct Params {
    uint counters;
};
PARAMS(Params)
layout(std430, binding = 0) buffer counters_block_ { uint counters_[]; };
shared uint sums_[GROUP];

void main()
{
    uint mine = gl_LocalInvocationIndex;
    uint share = (args.counters + uint(GROUP) - 1u) / uint(GROUP);
    uint begin = min(mine * share, args.counters);
    uint end = min(begin + share, args.counters);
    uint sum = 0u;
    for (uint i = begin; i < end; ++i)
        sum += counters_[i];
    sums_[mine] = sum;
    barrier();
    uint running = 0u;
    for (uint w = 0u; w < mine; ++w)
        running += sums_[w];
    for (uint i = begin; i < end; ++i) {
        uint n = counters_[i];
        counters_[i] = running;
        running += n;
    }
}
