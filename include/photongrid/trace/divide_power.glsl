// Divides the photons' power by the number of emitted paths when tracing has finished (Jensen 1996).
struct Params {
    float share; // 1 / paths
};
PARAMS(Params)
STATE(0, vec4, power)

void kernel(uint i)
{
    power = vec4(power.x * args.share, power.y * args.share, power.z * args.share, 0.0f);
}
