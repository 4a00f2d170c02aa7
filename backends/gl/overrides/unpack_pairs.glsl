// Unpacks pairs from texels with two pairs.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uvec4, texels)
OUTPUT(0, uvec2, pair)

void kernel(uint i)
{
    uvec4 t = texels(i >> 1u);
    pair = (i & 1u) == 0u ? uvec2(t.x, t.y) : uvec2(t.z, t.w);
}
