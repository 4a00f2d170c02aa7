// Divides an estimate by the share of its disc that lies on the surface (covered_share.glsl): what is missing there counts
// as like the rest. Polygons that overlap would count twice, so a share is at most 1; and at least `least`, since in the
// tip of a needle few photons say nothing. A point on no polygon keeps its estimate.
struct Params {
    float least;
    uint keeps_w; // 1: w is no part of the estimate
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
