// A step of the bitonic sort with addresses as a 2003 GPU had to compute them (section 4.1): no integers, buffers as textures
// 1,024 wide, so that every one-dimensional address is taken apart and put together in floats. To be counted and timed beside
// bitonic_step.glsl; not part of the library. Exact up to 2^24 pairs.
struct Params {
    float run;    // length of the runs being merged
    float stride; // distance between partners
};
PARAMS(Params)
INPUT(0, uvec2, pairs)
OUTPUT(0, uvec2, pair)

vec2 texel_of(float address)
{
    precise float row = floor(address * 0.0009765625f);
    precise float column = address - row * 1024.0f;
    return vec2(column + 0.5f, row + 0.5f);
}

uvec2 fetched(vec2 texel)
{
    precise float address = floor(texel.y) * 1024.0f + floor(texel.x);
    return pairs(uint(address));
}

// 1 where the bit of this power of two is set in a whole number, else 0
float bit_at(float number, float power)
{
    precise float quotient = floor(number / power);
    precise float odd = quotient - 2.0f * floor(quotient * 0.5f);
    return odd;
}

void kernel(uint i)
{
    vec2 here = texel_of(float(i)); // what a fragment's position tells
    precise float address = floor(here.y) * 1024.0f + floor(here.x);
    float upper = bit_at(address, args.stride);
    precise float partner_address = address + args.stride - 2.0f * upper * args.stride;
    uvec2 mine = fetched(here);
    uvec2 partner = fetched(texel_of(partner_address));
    bool rising = bit_at(address, args.run) == 0.0f;
    bool mine_is_less = mine.x < partner.x || (mine.x == partner.x && mine.y < partner.y);
    pair = ((upper == 0.0f) == rising) == mine_is_less ? mine : partner;
}
