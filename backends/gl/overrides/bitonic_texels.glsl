// One to three steps of a bitonic merge sort in one pass, on texels with two pairs. A step reads the texel's partner. A
// second step, with half the stride, needs another partner after the first step, so two more texels are read and
// compared. The step of stride 1 is within the texel.
#include "two_pairs.glsl"

struct Params {
    uint run;    // length of the runs being merged, in texels: 2, 4, …
    uint stride; // of the first step, in texels: run / 2, … 1
};
PARAMS(Params)
INPUT(0, uvec4, texels) // x, z: keys, y, w: values
OUTPUT(0, uvec4, texel)
SWITCH(0, SECOND_STEP)
SWITCH(1, LAST_STEP)

uvec4 after_first(uint i)
{
    uint partner = i ^ args.stride;
    return kept_of(texels(i), texels(partner), ((i & args.stride) == 0u) == ((i & args.run) == 0u));
}

void kernel(uint i)
{
    bool rising = (i & args.run) == 0u;
    texel = after_first(i);
    if (SECOND_STEP) {
        uint half_stride = args.stride >> 1;
        texel = kept_of(texel, after_first(i ^ half_stride), ((i & half_stride) == 0u) == rising);
    }
    if (LAST_STEP)
        texel = in_order(texel, rising);
}
