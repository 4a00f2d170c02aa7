// Squared distances as whole numbers in the same order, 0 below all of them; no denormals lie between 0 and the rest.
#ifndef PHOTONGRID_SHARED_IS_READ // backend/begin.hpp

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
