// Eight states and ten inputs, as many as a kernel may have; element i takes as many passes as `left` says.
struct Params {
    uint add;
};
PARAMS(Params)
SWITCH(1, DOUBLED)
INPUT(0, float, in0)
INPUT(1, vec2, in1)
INPUT(2, vec4, in2)
INPUT(3, uint, in3)
INPUT(4, uvec2, in4)
INPUT(5, uvec4, in5)
INPUT(6, uint, in6)
INPUT(7, uint, in7)
INPUT(8, uint, in8)
INPUT(9, uint, in9)
STATE(0, float, s0)
STATE(1, vec2, s1)
STATE(2, vec4, s2)
STATE(3, uint, s3)
STATE(4, uvec2, s4)
STATE(5, uvec4, s5)
STATE(6, uint, s6)
STATE(7, uint, left)

bool done() { return left == 0u; }
void kernel(uint i)
{
    s0 += in0(i);
    s1 += in1(i);
    s2 += in2(i);
    s3 += in3(i) + args.add;
    s4 += in4(i);
    s5 += in5(i);
    s6 += in6(i) + in7(i) + in8(i) + in9(i);
    left -= 1u;
    if (DOUBLED)
        s6 += 1000u;
}
