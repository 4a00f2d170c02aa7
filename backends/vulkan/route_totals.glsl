// The partial sums of each destination's amounts, one per block of draws, in draw order, so that they are the same on
// all devices. The number of draws per pass is bounded: software devices end long loops silently, others end long
// passes.
struct Params {
    uint destinations;
    uint sums;  // partial sums per destination
    uint block; // draws per partial sum
    uint begin; // draws of each partial sum that earlier passes have added
    uint most;  // draws that this pass adds at most
};
PARAMS(Params)
layout(std430, binding = 0) readonly buffer keys_block_ { uvec2 keys_[]; };
layout(std430, binding = 1) readonly buffer ranges_block_ { uvec2 ranges_[]; };
layout(std430, binding = 2) readonly buffer amounts_block_ { vec4 amounts_[]; };
layout(std430, binding = 3) buffer totals_block_ { vec4 totals_[]; };

// The first of a destination's keys, which are sorted by draw, that is not before this draw.
uint first_from(uvec2 range, uint draw)
{
    uint low = range.x;
    uint high = range.x + range.y;
    while (low < high) {
        uint middle = low + (high - low) / 2u;
        if (keys_[middle].y < draw)
            low = middle + 1u;
        else
            high = middle;
    }
    return low;
}

void main()
{
    uint index = element_();
    if (index >= launch_.x)
        return;
    uint d = index / args.sums;
    uint nth_sum = index - d * args.sums;
    uvec2 range = uvec2(0u, 0u);
    if (d < args.destinations) {
        uint first = first_from(ranges_[d], nth_sum * args.block);
        range = uvec2(first, first_from(ranges_[d], (nth_sum + 1u) * args.block) - first);
    }
    if (args.begin > 0u && range.y <= args.begin)
        return;
    vec4 sum = vec4(0.0);
    if (args.begin > 0u)
        sum = totals_[index];
    uint end = min(range.y, args.begin + args.most);
    for (uint r = args.begin; r < end; ++r)
        sum += amounts_[keys_[range.x + r].y];
    totals_[index] = sum;
}
