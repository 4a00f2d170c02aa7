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
// Of a mixture: the part that stores photons stored this one, which then left as from the other part, a specular one.
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
// Of BOTH_SURFACES, the power that leaves over that which was stored, which differ by shading normals: at most 256, in
// steps of 2^-8. `u` in [0, 1) rounds it so that its mean is right.
inline float event_of_both(uint end, uint before, float leaving, float u)
{
    precise float steps = leaving * 256.0f + u;
    uint rounded = steps < 65536.0f ? uint(steps) : 65536u;
    return event_code(BOTH_SURFACES, end, before) + float(rounded << EVENT_LEAVING_SHIFT);
}
inline float event_leaving(vec4 position)
{
    return float((uint(position.w) >> EVENT_LEAVING_SHIFT) & 131071u) / 256.0f;
}

#endif
