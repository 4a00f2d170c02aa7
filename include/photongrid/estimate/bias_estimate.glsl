// The bias of an estimate, from the sums of gather_bias.glsl. Where the light has a Laplacian L, an estimate by a
// filter is too high by L r^2 / 4 times the mean of d^2 / r^2 under the filter (Silverman 1986, section 4.3). The
// difference of the estimates by the constant filter and by Epanechnikov's is L r^2 / 24, so the bias is a multiple of
// it.
#include <photongrid/estimate/search_radius.glsl>

struct Params {
    float min_radius2; // m^2; see least_disc2
    float factor;      // by which the filter's bias is larger than the difference
};
PARAMS(Params)
INPUT(0, vec4, evens)
INPUT(1, vec4, slopes)
INPUT(2, vec4, tilts)
INPUT(3, vec4, jumps)
INPUT(4, vec4, irradiances) // w: squared radius of the estimate, m^2
INPUT(5, vec4, points)
OUTPUT(0, vec4, constant)   // rgb: irradiance by the constant filter, W/m^2
OUTPUT(1, vec4, bias)       // rgb, W/m^2
OUTPUT(2, vec4, tilt)       // xyz, W/m^2
OUTPUT(3, vec4, jump)       // xyz, W/m^2

void kernel(uint i)
{
    float per_area = 1.0f / (3.14159265f * max(irradiances(i).w, least_disc2(points(i), args.min_radius2)));
    vec4 e = evens(i);
    vec4 s = slopes(i);
    vec4 t = tilts(i);
    vec4 j = jumps(i);
    float of_slope = per_area * args.factor;
    constant = vec4(e.x * per_area, e.y * per_area, e.z * per_area, 0.0f);
    bias = vec4(s.x * of_slope, s.y * of_slope, s.z * of_slope, 0.0f);
    tilt = vec4(t.x * per_area, t.y * per_area, t.z * per_area, 0.0f);
    jump = vec4(j.x * per_area, j.y * per_area, j.z * per_area, 0.0f);
}
