// Corrects the bias of an estimate whose disc lies partly off the surface (edge_correction.hpp): each of the two
// estimates whose difference tells it is divided by its own share of the disc, as in divide_by_share.glsl. The moments
// of the light over a part of a disc tell nothing of steps, so they become 0.
struct Params {
    float factor; // of the filter: bias_factor (estimate/filter.hpp)
    float least;  // smaller shares count as this
};
PARAMS(Params)
INPUT(0, vec4, covers)     // by the constant filter: x: share; y: 1: the point is on a polygon
INPUT(1, vec4, inner)      // the same by Epanechnikov's
INPUT(2, vec4, constants)  // rgb: irradiance by the constant filter, W/m^2
STATE(0, vec4, bias)       // rgb, W/m^2
STATE(1, vec4, tilt)       // xyz, W/m^2
STATE(2, vec4, jump)       // xyz, W/m^2

void kernel(uint i)
{
    vec4 c = covers(i);
    if (!(c.y > 0.0f) || !(c.x < 0.9999f))
        return;
    float whole = max(c.x, args.least);
    float inside = max(min(inner(i).x, 1.0f), args.least);
    vec4 even = constants(i);
    vec4 epanechnikov = even - bias / args.factor;
    vec4 corrected = (even / whole - epanechnikov / inside) * args.factor;
    bias = vec4(corrected.x, corrected.y, corrected.z, 0.0f);
    tilt = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    jump = tilt;
}
