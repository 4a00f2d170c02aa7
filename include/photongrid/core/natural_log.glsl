// The natural logarithm of a finite x >= 1 without `log`, whose results differ between devices: the exponent from the
// bits, the rest by the series of 2 artanh((m - 1) / (m + 1)), m from 1/sqrt(2) to sqrt(2). The series is cut at 7e-10;
// with float's rounding the error is below 2e-7 or one part in 2^22, whichever is larger.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

inline float natural_log(float x)
{
    uint bits = floatBitsToUint(x);
    float exponent = float(bits >> 23u) - 127.0f;
    float m = uintBitsToFloat((bits & 0x7FFFFFu) | 0x3F800000u);
    if (m > 1.41421356f) {
        m = 0.5f * m;
        exponent = exponent + 1.0f;
    }
    precise float z = (m - 1.0f) / (m + 1.0f);
    precise float q = z * z;
    precise float series = 2.0f * z * (1.0f + q * (0.333333333f + q * (0.2f + q * (0.142857143f + q * 0.111111111f))));
    precise float logarithm = exponent * 0.693147181f + series;
    return logarithm;
}

#endif
