// The filters of an estimate: how much a photon counts by its distance d from the query point, for a radius r (Jensen
// 2001, section 7.3; Silverman 1986). Included by kernels: the only code on devices that depends on the
// filter. Its enumerator, its name and its norm are in filter.hpp.
#include <photongrid/core/natural_log.glsl>

// None of them on: the constant filter. The bit of filter f is 15 + f (filter_switch); kernels use bits below 16.
SWITCH(16, CONE)         // 1 - d / r
SWITCH(17, EPANECHNIKOV) // 1 - d^2 / r^2
SWITCH(18, SILVERMAN)    // (1 - d^2 / r^2)^2

// The weight of a photon at t = d^2 / r^2, from 0 to 1.
float filter_weight(float t)
{
    float weight = 1.0f;
    if (CONE)
        weight = 1.0f - sqrt(t);
    if (EPANECHNIKOV)
        weight = 1.0f - t;
    if (SILVERMAN)
        weight = (1.0f - t) * (1.0f - t);
    return weight;
}

// The logarithm in the cone's integrals along an edge at distance e from the disc's centre: of (|s| + rho) / |e|, with
// the sign of s. s: from the foot of the centre on the edge; rho: from the centre; all lengths are divided by r.
float edge_logarithm(float e, float s, float rho)
{
    precise float e2 = e * e;
    float logarithm = 0.0f; // its term vanishes with e
    if (e2 > 1e-8f) {
        precise float ratio = (abs(s) + rho) / abs(e);
        logarithm = natural_log(ratio);
    }
    return s < 0.0f ? -logarithm : logarithm;
}

// filter_edge_integral and filter_edge_moment (below) of filters that kernels need whatever the SWITCHes say.
float epanechnikov_edge_integral(float e, float s)
{
    precise float e2 = e * e;
    precise float s2 = s * s;
    precise float value = s * (2.0f - e2 - 0.333333333f * s2);
    return value;
}
float constant_edge_moment(float e, float s)
{
    precise float h2 = 1.0f - e * e;
    precise float s2 = s * s;
    precise float value = s * (h2 - 0.333333333f * s2);
    return value;
}
float epanechnikov_edge_moment(float e, float s)
{
    precise float h2 = 1.0f - e * e;
    precise float s2 = s * s;
    precise float value = s * (h2 * h2 - 0.666666667f * h2 * s2 + 0.2f * s2 * s2);
    return value;
}

// For the share of a disc that lies on a surface (covered_share.glsl): 2 pi / e times the indefinite integral of the
// weight over the triangles between the disc's centre and an edge, which lies at distance e from it. s: from the foot
// of the centre on the edge; all lengths are divided by r. The integral over the whole disc is 1.
float filter_edge_integral(float e, float s)
{
    precise float e2 = e * e;
    precise float s2 = s * s;
    precise float value = s;
    if (CONE) {
        precise float rho = sqrt(e2 + s2);
        float logarithm = edge_logarithm(e, s, rho);
        precise float with_cone = 3.0f * s - s * rho - e2 * logarithm;
        value = with_cone;
    }
    if (EPANECHNIKOV)
        value = epanechnikov_edge_integral(e, s);
    if (SILVERMAN) {
        precise float with_silverman = s * (3.0f - 3.0f * e2 - s2 + e2 * e2 + 0.666666667f * e2 * s2 + 0.2f * s2 * s2);
        value = with_silverman;
    }
    return value;
}

// For the first moment of a disc's part that lies on a surface (covered_moments.glsl): 2 pi times the indefinite
// integral, along an edge at distance e from the disc's centre, of the integral of the weight times radius from there
// to the rim. The weight is normalised to 1 over the whole disc.
float filter_edge_moment(float e, float s)
{
    precise float e2 = e * e;
    precise float s2 = s * s;
    precise float h2 = 1.0f - e2;
    precise float value = constant_edge_moment(e, s);
    if (CONE) {
        precise float rho = sqrt(e2 + s2);
        float logarithm = edge_logarithm(e, s, rho);
        precise float with_cone = s * (1.0f - 3.0f * e2 - s2 + 0.5f * rho * (e2 + s2) + 0.75f * e2 * rho)
            + 0.75f * e2 * e2 * logarithm;
        value = with_cone;
    }
    if (EPANECHNIKOV)
        value = epanechnikov_edge_moment(e, s);
    if (SILVERMAN) {
        precise float with_silverman
            = s * (h2 * h2 * h2 - h2 * h2 * s2 + 0.6f * h2 * s2 * s2 - 0.142857143f * s2 * s2 * s2);
        value = with_silverman;
    }
    return value;
}
