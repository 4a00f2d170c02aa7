// The result of the search for a radius, which gather_photons.glsl and list_neighbours.glsl use. kth_result.glsl,
// grown_radius.glsl and given_radius.glsl write it; kth_tie.glsl finds the last id.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

// `search_radius`: x: squared radius, m^2; y: 1 if a photon set it, 0 if it was given.
inline vec4 search_radius_of(float radius2, bool is_by_photon)
{
    return vec4(radius2, is_by_photon ? 1.0f : 0.0f, 0.0f, 0.0f);
}
inline float radius2_of(vec4 search_radius)
{
    return search_radius.x;
}
inline bool is_by_photon(vec4 search_radius)
{
    return search_radius.y > 0.0f;
}

// The radii of a search for at least k photons in a block map: squared radii in steps of a quarter of a power of two.
// Returns the smallest one that is not smaller than radius2; 0 is the first.
inline float next_in_series(float radius2)
{
    uint bits = floatBitsToUint(radius2);
    return radius2 > 0.0f ? uintBitsToFloat((bits + 0x001FFFFFu) & 0xFFE00000u) : 0.0f;
}

// The least squared radius of the disc of an estimate at a point, m^2: min_radius2, but at least (2^-24 c)^2, where c
// is the point's largest coordinate. Rounding moves coordinates by up to 2^-24 of themselves, so photons whose stored
// positions are equal may lie that far apart.
inline float least_disc2(vec4 point, float min_radius2)
{
    float x = abs(point.x);
    float y = abs(point.y);
    float z = abs(point.z);
    float largest = y > x ? y : x;
    float rounding = (z > largest ? z : largest) * 5.9604645e-8f; // 2^-24
    float rounding2 = rounding * rounding;
    return rounding2 > min_radius2 ? rounding2 : min_radius2; // min_radius2 for NaN
}

// Whether an unbiased estimate excludes the photon that set the radius. If that photon lies within the least radius of
// an estimate's disc, it does not set the disc's radius, and it counts.
inline bool excludes_photon(vec4 search_radius, float least2)
{
    return is_by_photon(search_radius) && radius2_of(search_radius) >= least2;
}

// `chosen`: x, y: see search_tally.glsl; z: the last id that counts at the radius itself; w: how often that id counts
// there, since routed maps repeat photons.
inline uvec4 chosen_of(uint found, uint visited, uint last_id, uint last_count)
{
    return uvec4(found, visited, last_id, last_count);
}
inline uint last_id_of(uvec4 chosen)
{
    return chosen.z;
}
inline uint last_id_count(uvec4 chosen)
{
    return chosen.w;
}

#endif
