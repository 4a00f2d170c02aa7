// Corrects the bias of an estimate whose disc lies partly off its surface (edge_correction.hpp). Let the light be
// E + G u, with the offset u from the disc's centre over the radius. Over a whole disc the slope G adds nothing. Over a
// part of it, every estimate that is divided by its share of the disc is too high by G times the part's first moment
// over its share. Two equations have E and G: sums of the photons' flux, and of flux times offset, by the constant
// filter, against the moments of the part of the disc (covered_moments.glsl).
//
// So the bias is that of the slope, plus that of curvature, from the difference of two estimates less what the
// slope adds to it. The moments of the light over a part of a disc tell nothing of steps, so they become 0.
#include <photongrid/core/vector.glsl>

struct Params {
    float factor; // of the filter: bias_factor (estimate/filter.hpp)
    float least;  // smaller shares count as this
};
PARAMS(Params)
INPUT(0, vec4, covers)    // covered_share.glsl: x: share by the filter; y: 1: the point is on a polygon
INPUT(1, vec4, shares)    // covered_moments.glsl
INPUT(2, vec4, firsts)    // the same
INPUT(3, vec4, seconds)   // the same
INPUT(4, vec4, constants) // rgb: irradiance by the constant filter, W/m^2
INPUT(5, vec4, surfaces)  // xyz: unit normal
STATE(0, vec4, bias)      // rgb, W/m^2
STATE(1, vec4, tilt)      // xyz, W/m^2
STATE(2, vec4, jump)      // xyz, W/m^2

void kernel(uint i)
{
    vec4 c = covers(i);
    vec4 s = shares(i);
    if (!(c.y > 0.0f) || !(s.x < 0.9999f))
        return;
    float whole = max(s.x, args.least);
    float inside = max(min(s.y, 1.0f), args.least);
    float filtered = max(min(c.x, 1.0f), args.least);
    vec4 f = firsts(i);
    vec4 m = seconds(i);
    vec4 even = constants(i);
    vec4 epanechnikov = even - bias / args.factor;

    // The slope of the mean of the channels: the covariance of the part of the disc against that of its photons.
    float mean = (even.x + even.y + even.z) * 0.333333333f;
    vec3 moment = in_basis(vec3(tilt), vec3(surfaces(i)));
    float of_offset = 1.0f / whole;
    float uu = m.x - f.x * f.x * of_offset;
    float uv = m.y - f.x * f.y * of_offset;
    float vv = m.z - f.y * f.y * of_offset;
    float u = moment.x - f.x * mean * of_offset;
    float v = moment.y - f.y * mean * of_offset;
    float determinant = uu * vv - uv * uv;
    float trace = uu + vv;
    vec2 slope = vec2(0.0f, 0.0f); // of a needle it is not known
    if (determinant > 1e-4f * trace * trace && mean > 0.0f)
        slope = vec2((vv * u - uv * v) / determinant, (uu * v - uv * u) / determinant);
    float of_slope = (slope.x * s.z + slope.y * s.w) / filtered;
    float in_difference = slope.x * (f.x / whole - f.z / inside) + slope.y * (f.y / whole - f.w / inside);

    // All channels have the same slope, relative to their light.
    float per_light = mean > 0.0f ? (of_slope - args.factor * in_difference) / mean : 0.0f;
    vec4 corrected = (even / whole - epanechnikov / inside) * args.factor + even * per_light;
    bias = vec4(corrected.x, corrected.y, corrected.z, 0.0f);
    tilt = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    jump = tilt;
}
