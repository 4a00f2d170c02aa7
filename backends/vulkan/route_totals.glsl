// The sum of each destination's amounts in the order of the draws, a bounded number of them a pass: software devices end
// loops silently, others kill long passes. The order makes the sum the same on every device.
struct Params {
    uint destinations;
    uint begin; // draws of each destination that earlier passes have added
    uint most;  // draws that this pass adds at most
};
PARAMS(Params)
layout(std430, binding = 0) readonly buffer keys_block_ { uvec2 keys_[]; };
layout(std430, binding = 1) readonly buffer ranges_block_ { uvec2 ranges_[]; };
layout(std430, binding = 2) readonly buffer amounts_block_ { vec4 amounts_[]; };
layout(std430, binding = 3) buffer totals_block_ { vec4 totals_[]; };

void main()
{
    uint d = element_();
    if (d >= launch_.x)
        return;
    uvec2 range = d < args.destinations ? ranges_[d] : uvec2(0u, 0u);
    if (args.begin > 0u && range.y <= args.begin)
        return;
    vec4 sum = vec4(0.0);
    if (args.begin > 0u)
        sum = totals_[d];
    uint end = min(range.y, args.begin + args.most);
    for (uint r = args.begin; r < end; ++r)
        sum += amounts_[keys_[range.x + r].y];
    totals_[d] = sum;
}
