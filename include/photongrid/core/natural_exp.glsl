// e^-x of x >= 0 without `exp`, whose results differ between devices: 2^n times the series of e^r, r from -ln(2)/2 to
// ln(2)/2. The error is below 3e-7 of the result; below 1.2e-38 the result is 0. Of infinity it is 0, of NaN too.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

inline float exp_of_minus(float x)
{
    if (!(x < 87.0f))
        return 0.0f;
    precise float halves = floor(x * 1.44269504f + 0.5f);
    // ln(2) in two parts: the first one times a whole number below 2^9 is exact.
    precise float r = (x - halves * 0.693145752f) - halves * 1.42860677e-6f;
    precise float last = 0.0416666667f - r * (0.00833333333f - r * 0.00138888889f);
    precise float series = 1.0f - r * (1.0f - r * (0.5f - r * (0.166666667f - r * last)));
    precise float scaled = series * uintBitsToFloat((127u - uint(halves)) << 23u);
    return scaled;
}

#endif
