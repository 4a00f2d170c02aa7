// The weights of a photon in the sums for the bias of an estimate (gather_bias.glsl). t = d^2 / r^2, from 0 to 1,
// for a photon at distance d in a disc of radius r; rho = d / r. Included by kernels.

// Legendre's polynomial of degree 1 in t: its mean over the disc is 0 where light is even or has a slope, and for light
// with a Laplacian L it is r^2 L / 24. It is the weight of the constant filter less that of Epanechnikov's, and of all
// weights with these means it is the one with the least variance.
float curve_weight(float t)
{
    precise float weight = 2.0f * t - 1.0f;
    return weight;
}

// The weight of a photon's offset d / r in a first moment that is 0 where light has a slope. Where it steps by H on a
// line through the disc's centre, the moment is H (1 / pi - 8 / (9 pi)) = H / (9 pi).
float jump_weight(float t)
{
    precise float rho = sqrt(t);
    float inverse = 0.0f; // the offset is 0, too
    if (rho > 1e-9f)
        inverse = 1.0f / rho;
    precise float weight = inverse - 1.33333333f;
    return weight;
}
