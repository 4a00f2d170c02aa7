// Slot r of destination d: the payload of its r-th draw, if it exists.
struct Params {
    uint destinations;
    uint capacity;
};
PARAMS(Params)
layout(std430, binding = 0) readonly buffer keys_block_ { uvec2 keys_[]; };
layout(std430, binding = 1) readonly buffer ranges_block_ { uvec2 ranges_[]; };
layout(std430, binding = 2) readonly buffer payload_block_ { uint payload_[]; };
layout(std430, binding = 3) buffer slots_block_ { uint slots_[]; };

void main()
{
    uint s = element_();
    if (s >= launch_.x)
        return;
    uint d = s / args.capacity;
    uint r = s - d * args.capacity;
    uint value = 0xFFFFFFFFu;
    if (d < args.destinations) {
        uvec2 range = ranges_[d];
        if (r < range.y)
            value = payload_[keys_[range.x + r].y];
    }
    slots_[s] = value;
}
