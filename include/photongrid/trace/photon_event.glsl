// A path's event at one surface, stored in the w of its position in a frame: kind of surface + 4 * end + 32 * surfaces
// before.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // backend/begin.hpp

// Kinds of surface
const uint NO_SURFACE = 0u;
const uint SPECULAR_SURFACE = 1u;
const uint DIFFUSE_SURFACE = 2u;

// How the path continues or ends
const uint GOES_ON = 0u;
const uint ABSORBED = 1u;
const uint ESCAPED = 2u;      // a miss: the paper's "invalid" mark (2.1)
const uint CUT_OFF = 3u;      // reached the depth limit
const uint NOT_A_NUMBER = 4u; // became NaN or infinite
const uint ENDED_BEFORE = 5u;

// The surfaces that the path hit before: none; mirrors and glass only (a caustic photon); a diffuse surface
const uint NOTHING_BEFORE = 0u;
const uint SPECULAR_BEFORE = 1u;
const uint DIFFUSE_BEFORE = 2u;

inline float event_code(uint kind, uint end, uint before)
{
    return float(kind + 4u * end + 32u * before);
}
inline uint event_kind(vec4 position)
{
    return uint(position.w) & 3u;
}
inline uint event_end(vec4 position)
{
    return (uint(position.w) >> 2u) & 7u;
}
inline uint event_before(vec4 position)
{
    return uint(position.w) >> 5u;
}

#endif
