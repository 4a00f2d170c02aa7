// Divides an estimate by the share of its disc that lies on the surface (covered_share.glsl). The share is clamped to
// 1, because polygons that overlap count twice, and to `least`, because in a sharp corner there are too few photons for
// a correction. Points that are on no polygon keep their estimates.
struct Params {
    float least;
    uint keeps_w; // 1: w is not part of the estimate and stays
};
PARAMS(Params)
INPUT(0, vec4, covers)
STATE(0, vec4, estimate)

void kernel(uint i)
{
    vec4 c = covers(i);
    if (!(c.y > 0.0f))
        return;
    float share = max(min(c.x, 1.0f), args.least);
    precise vec4 whole = estimate / share;
    estimate = vec4(whole.x, whole.y, whole.z, args.keeps_w != 0u ? estimate.w : whole.w);
}
