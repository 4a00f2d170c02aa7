// Counter-based random numbers: a hash of a key and a seed, so that results depend neither on the backend nor on the
// order or the number of threads. Jarzynski and Olano, Hash Functions for GPU Rendering, JCGT 9(3), 2020 (pcg4d).
// And sequences whose points are spread more evenly than random ones.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

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

// A bijection of 32 bits in which every bit of the result depends on every bit of x, evenly (Wellons, Prospecting for
// Hash Functions, 2018: lowbias32). Unlike a component of hash4 it is even where few bits of the key vary.
inline uint scrambled(uint x)
{
    x ^= x >> 16u;
    x *= 0x7FEB352Du;
    x ^= x >> 15u;
    x *= 0x846CA68Bu;
    return x ^ (x >> 16u);
}

// A seeded permutation of 0 … n-1 whose orders by any seeds are as random as `scrambled`: a Feistel network (Luby and
// Rackoff 1988) on an even number of bits, at least 8, walked until it lands inside (fewer than four steps on average
// for n > 64). It is for samples with statistics to keep: `permuted` costs less, but its orders by neighbouring seeds
// are shifts of each other.
inline uint shuffled(uint index, uint n, uint seed)
{
    uint half_bits = 4u;
    while (half_bits < 16u && ((n - 1u) >> (2u * half_bits)) != 0u)
        ++half_bits;
    uint low_half = (1u << half_bits) - 1u;
    uint x = index;
    do {
        for (uint turn = 0u; turn < 6u; ++turn) {
            uint right = x & low_half;
            uint key = scrambled(seed + turn * 0x9E3779B9u);
            uint left = (x >> half_bits) ^ (scrambled(right ^ key) & low_half);
            x = (right << half_bits) | left;
        }
    } while (x >= n);
    return x;
}

// Sobol's (0,2)-sequence, scrambled as by Owen (Scrambled Net Variance for Integrals of Smooth Functions, 1997): for
// all n and m its points m 2^n to (m + 1) 2^n - 1 lie one in each of the 2^n equal rectangles into which halving
// divides the square, whatever their proportions. So any number of points from the first on is spread evenly. By itself
// each point is random. Points of sequences with keys of their own are independent of each other, because each
// sequence has an order of its own (Burley, Practical Hash-based Owen Scrambling, JCGT 9(4), 2020).

inline uint reversed_bits(uint x)
{
    x = ((x >> 1u) & 0x55555555u) | ((x & 0x55555555u) << 1u);
    x = ((x >> 2u) & 0x33333333u) | ((x & 0x33333333u) << 2u);
    x = ((x >> 4u) & 0x0F0F0F0Fu) | ((x & 0x0F0F0F0Fu) << 4u);
    x = ((x >> 8u) & 0x00FF00FFu) | ((x & 0x00FF00FFu) << 8u);
    return (x >> 16u) | (x << 16u);
}

// A seeded bijection in which a bit of the result depends on the bits of x up to its own place: a nested uniform
// scramble of a number whose bits are in reverse (Laine and Karras 2011, with the constants of Vegdahl, Building a
// Better LK Hash, 2021).
//
// It needs seeds whose every bit is random: those of hash4 by themselves, over neighbouring keys, tied sequences to
// each other.
inline uint nested_scrambled(uint x, uint key)
{
    uint seed = scrambled(key);
    x ^= x * 0x3D20ADEAu;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526C56u;
    x ^= x * 0x53A22864u;
    return x;
}

// The place of point `nth` in its sequence's own order.
inline uint place_in_sequence(uint nth, uint seed)
{
    return reversed_bits(nested_scrambled(reversed_bits(nth), seed));
}

// The coordinates of the point at a place.
inline float sequence_x(uint place, uint seed)
{
    return unit_float(reversed_bits(nested_scrambled(place, seed)));
}
inline float sequence_y(uint place, uint seed)
{
    // Sobol's second generator matrix is Pascal's triangle modulo 2, a product of these five.
    place ^= (place >> 1u) & 0x55555555u;
    place ^= (place >> 2u) & 0x33333333u;
    place ^= (place >> 4u) & 0x0F0F0F0Fu;
    place ^= (place >> 8u) & 0x00FF00FFu;
    place ^= place >> 16u;
    return unit_float(reversed_bits(nested_scrambled(place, seed)));
}

// Point `nth` of the sequence of a key.
inline vec2 sequence2(uint nth, uvec4 key)
{
    uvec4 h = hash4(key);
    uint place = place_in_sequence(nth, h.x);
    return vec2(sequence_x(place, h.y), sequence_y(place, h.z));
}

// Points `nth` of two sequences of a key: xy and zw.
inline vec4 sequence4(uint nth, uvec4 key)
{
    uvec4 h = hash4(key);
    uint place = place_in_sequence(nth, h.x);
    uint other = place_in_sequence(nth, scrambled(h.x ^ h.w));
    return vec4(sequence_x(place, h.y), sequence_y(place, h.z), sequence_x(other, scrambled(h.y ^ h.w)),
        sequence_y(other, scrambled(h.z ^ h.w)));
}

#endif
