// Counter-based random numbers: a hash of a key and a seed, so that results depend neither on the backend nor on the
// order or the number of threads. Jarzynski and Olano, Hash Functions for GPU Rendering, JCGT 9(3), 2020 (pcg4d).
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // backend/begin.hpp

inline uvec4 hash4(uvec4 key)
{
    uvec4 v = key * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v = v ^ (v >> 16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// 24 bits to [0, 1): exact, and never 1 (dividing by 2^32 in float would round up to 1).
inline float unit_float(uint bits)
{
    return float(bits >> 8u) * 5.9604644775390625e-8f;
}

inline vec4 random4(uvec4 key)
{
    uvec4 h = hash4(key);
    return vec4(unit_float(h.x), unit_float(h.y), unit_float(h.z), unit_float(h.w));
}

// A seeded permutation of 0 … n-1, as a pure function of the index: a bijection of the next power of two, walked until
// it lands inside (fewer than two steps on average).
inline uint permuted(uint index, uint n, uint seed)
{
    uint mask = n - 1u;
    mask |= mask >> 1u;
    mask |= mask >> 2u;
    mask |= mask >> 4u;
    mask |= mask >> 8u;
    mask |= mask >> 16u;
    uint x = index;
    do {
        // Each step is a bijection on the bits of mask: add, multiply by an odd number, fold high bits down.
        x = (x + seed) & mask;
        x = (x * 0x9E3779B1u) & mask;
        x ^= x >> 7u;
        x = (x + (seed >> 11u)) & mask;
        x = (x * 0x85EBCA77u) & mask;
        x ^= x >> 5u;
        x = (x * 0xC2B2AE3Du) & mask;
        x ^= x >> 11u;
        x = (x + (seed >> 21u)) & mask;
        x = (x * 0x27D4EB2Fu) & mask;
        x ^= x >> 3u;
    } while (x >= n);
    return x;
}

#endif
