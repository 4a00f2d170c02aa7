// True for an eye ray that ended on a rough surface (eye_bounce.glsl).
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, points)

bool holds(uint i)
{
    return points(i).w <= -2.0f;
}
