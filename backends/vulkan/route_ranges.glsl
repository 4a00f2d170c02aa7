// The range of each destination's draws in the sorted keys, and the largest number of draws of any destination.
struct Params {
    uint keys;
};
PARAMS(Params)
layout(std430, binding = 0) readonly buffer keys_block_ { uvec2 keys_[]; };
layout(std430, binding = 1) buffer ranges_block_ { uvec2 ranges_[]; };
layout(std430, binding = 2) buffer most_block_ { uint most_; };

uint keys_below(uint destination)
{
    uint low = 0u;
    uint high = args.keys;
    while (low < high) {
        uint middle = low + (high - low) / 2u;
        if (keys_[middle].x < destination)
            low = middle + 1u;
        else
            high = middle;
    }
    return low;
}

void main()
{
    uint d = element_();
    if (d >= launch_.x)
        return;
    uint first = keys_below(d);
    uint count = keys_below(d + 1u) - first;
    ranges_[d] = uvec2(first, count);
    if (count > 0u)
        atomicMax(most_, count);
}
