// A path's event at one surface, stored in the w of its position in a frame as a whole number below 2^24. From its low
// bits on: the kind of surface, how the path ends, the power that leaves, the surfaces before.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

const uint EVENT_END_SHIFT = 2u;
const uint EVENT_LEAVING_SHIFT = 5u;
const uint EVENT_BEFORE_SHIFT = 22u;

// Kinds of surface
const uint NO_SURFACE = 0u;
const uint SPECULAR_SURFACE = 1u;
const uint DIFFUSE_SURFACE = 2u;
// The surface stored the photon, which then left otherwise: of a mixture as from the other part, a specular one; or
// straight on, where the surface is clear in part.
const uint BOTH_SURFACES = 3u;

// How the path continues or ends
const uint GOES_ON = 0u;
const uint ABSORBED = 1u;
const uint ESCAPED = 2u;      // a miss: the paper's "invalid" mark (2.1)
const uint CUT_OFF = 3u;      // reached the depth limit
const uint NOT_A_NUMBER = 4u; // became NaN or infinite
const uint ENDED_BEFORE = 5u;

// The surfaces that the path hit before, but for clear ones: none; mirrors and glass only (a caustic photon); a diffuse
// surface
const uint NOTHING_BEFORE = 0u;
const uint SPECULAR_BEFORE = 1u;
const uint DIFFUSE_BEFORE = 2u;

inline float event_code(uint kind, uint end, uint before)
{
    return float(kind + (end << EVENT_END_SHIFT) + (before << EVENT_BEFORE_SHIFT));
}
inline uint event_kind(vec4 position)
{
    return uint(position.w) & 3u;
}
inline uint event_end(vec4 position)
{
    return (uint(position.w) >> EVENT_END_SHIFT) & 7u;
}
inline uint event_before(vec4 position)
{
    return uint(position.w) >> EVENT_BEFORE_SHIFT;
}
// What ends paths besides absorption: nothing; the first diffuse surface, as those of caustic photons; the first
// surface that is not smooth, as those of photons on rough surfaces (rough_photons.hpp).
const uint NOTHING_ENDS = 0u;
const uint DIFFUSE_ENDS = 1u;
const uint ROUGH_ENDS = 2u;

// Whether the surface stored the photon, or left it to the direct light.
inline bool event_is_diffuse(vec4 position)
{
    return event_kind(position) >= DIFFUSE_SURFACE;
}
// Which photons a map stores, as a sum of these. One straight from a light, or through clear surfaces, is a first hit.
const uint FIRST_HITS = 1u;   // else left to the direct light
const uint CAUSTICS = 2u;     // else left to a map of caustic photons
const uint OTHER_PHOTONS = 4u;
inline bool event_is_stored(vec4 position, uint kinds)
{
    return event_is_diffuse(position) && ((kinds >> event_before(position)) & 1u) != 0u;
}
// Of BOTH_SURFACES, the power that leaves over that which was stored, which differ by shading normals: below 256, in
// steps of 2^-8. `u` in [0, 1) rounds it so that its mean is right. `straight`: it goes straight on.
inline float event_of_both(uint end, uint before, float leaving, float u, bool straight)
{
    precise float steps = leaving * 256.0f + u;
    uint rounded = steps < 65535.0f ? uint(steps) : 65535u;
    return event_code(BOTH_SURFACES, end, before)
        + float((rounded + (straight ? 65536u : 0u)) << EVENT_LEAVING_SHIFT);
}
inline float event_leaving(vec4 position)
{
    return float((uint(position.w) >> EVENT_LEAVING_SHIFT) & 65535u) / 256.0f;
}
inline bool event_goes_straight_on(vec4 position)
{
    return ((uint(position.w) >> EVENT_LEAVING_SHIFT) & 65536u) != 0u;
}

#endif
