// Counts for path i, over all its frames: how it ended, and its diffuse hits. Photons straight from a light are stored
// only for a final gather; else shadow rays compute their light.
#include <photongrid/trace/photon_event.glsl>

struct Params {
    uint paths;
    uint frames;     // traced so far, frame 0 included
    uint first_hits; // 1: they are stored, too
};
PARAMS(Params)
INPUT(0, vec4, positions)
OUTPUT(0, uint, storable) // diffuse hits that are stored
OUTPUT(1, uvec4, ends)    // a 1 for its end: absorbed, escaped, cut off, not a number
OUTPUT(2, uvec4, hits)    // diffuse hits; those left to the direct light

void kernel(uint i)
{
    storable = 0u;
    ends = uvec4(0u, 0u, 0u, 0u);
    hits = uvec4(0u, 0u, 0u, 0u);
    for (uint frame = 1u; frame < args.frames; ++frame) {
        vec4 p = positions(frame * args.paths + i);
        uint end = event_end(p);
        if (end == ENDED_BEFORE)
            break;
        if (event_is_diffuse(p)) {
            ++hits.x;
            if (event_is_stored(p, args.first_hits != 0u))
                ++storable;
            else
                ++hits.y;
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
