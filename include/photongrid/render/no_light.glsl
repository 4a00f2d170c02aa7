// Makes emissions of eye rays dark; w, which rough_end.glsl reads, stays.
struct Params {
    uint unused;
};
PARAMS(Params)
STATE(0, vec4, emission)

void kernel(uint i)
{
    emission = vec4(0.0f, 0.0f, 0.0f, emission.w);
}
