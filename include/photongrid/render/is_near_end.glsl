// True for a near end of a final gather (add_gathered.glsl).
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, ends)

bool holds(uint i)
{
    return ends(i).w > 0.0f;
}
