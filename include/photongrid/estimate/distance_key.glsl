// Maps squared distances to integers that have the same order. 0 is below all of them. Denormals count as distance 0.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

inline uint key_of(float d2)
{
    uint bits = floatBitsToUint(d2);
    return bits < 0x00800000u ? 1u : bits - 0x007FFFFEu;
}
inline float distance_of(uint key)
{
    return key < 2u ? 0.0f : uintBitsToFloat(key + 0x007FFFFEu);
}

#endif
