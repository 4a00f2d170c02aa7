// The pair (destination, draw) of every draw. Destinations that do not exist become the largest key.
struct Params {
    uint destinations;
};
PARAMS(Params)
layout(std430, binding = 0) readonly buffer destination_block_ { uint destination_[]; };
layout(std430, binding = 1) buffer keys_block_ { uvec2 keys_[]; };

void main()
{
    uint i = element_();
    if (i < launch_.x)
        keys_[i] = uvec2(min(destination_[i], args.destinations), i);
}
