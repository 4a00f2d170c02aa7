// Counts for path i, over all its frames: how it ended, and its diffuse hits. Those that are not stored are left to
// shadow rays or to a map of caustic photons.
#include <photongrid/trace/photon_event.glsl>

struct Params {
    uint paths;
    uint frames; // traced so far, frame 0 included
    uint kinds;  // of photons that are stored (photon_event.glsl)
};
PARAMS(Params)
INPUT(0, vec4, positions)
OUTPUT(0, uint, storable) // diffuse hits that are stored
OUTPUT(1, uvec4, ends)    // a 1 for its end: absorbed, escaped, cut off, not a number
OUTPUT(2, uvec4, hits)    // diffuse hits; those left to the direct light; to a map of caustic photons

void kernel(uint i)
{
    storable = 0u;
    ends = uvec4(0u, 0u, 0u, 0u);
    hits = uvec4(0u, 0u, 0u, 0u);
    uint end = GOES_ON;
    for (uint frame = 1u; frame < args.frames && end == GOES_ON; ++frame) {
        vec4 p = positions(frame * args.paths + i);
        end = event_end(p);
        if (event_is_diffuse(p)) {
            ++hits.x;
            if (event_is_stored(p, args.kinds))
                ++storable;
            else if (event_before(p) == NOTHING_BEFORE)
                ++hits.y;
            else
                ++hits.z;
        }
        if (end == ABSORBED)
            ends.x = 1u;
        if (end == ESCAPED)
            ends.y = 1u;
        if (end == CUT_OFF)
            ends.z = 1u;
        if (end == NOT_A_NUMBER)
            ends.w = 1u;
    }
}
