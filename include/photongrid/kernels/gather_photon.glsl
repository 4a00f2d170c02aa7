// Stored photon i, looked up in the frames: photons stand in the order of (path, bounce). A gather in place of the scatter
// that fragment programs lack: binary search for the path in the running sums, then its r-th diffuse hit.
#include "photon_event.glsl"

struct Params {
    uint paths;
    uint frames;
    uint stored_before; // photons of earlier batches
};
PARAMS(Params)
INPUT(0, uint, sums) // storable photons of paths 0 to i
INPUT(1, vec4, positions)
INPUT(2, vec4, powers)
INPUT(3, vec4, directions)
OUTPUT(0, vec4, position)
OUTPUT(1, vec4, power)
OUTPUT(2, vec4, direction)

void kernel(uint i)
{
    uint rank = i - args.stored_before;
    uint low = 0u;
    uint high = args.paths - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (sums(middle) > rank)
            high = middle;
        else
            low = middle + 1u;
    }
    // Count down from the path's last photon: sums(low) is one past it.
    uint skip = sums(low) - 1u - rank;
    uint found = low;
    for (uint frame = args.frames - 1u; frame >= 2u; --frame) {
        uint at = frame * args.paths + low;
        if (event_kind(positions(at)) == DIFFUSE_SURFACE) {
            if (skip == 0u) {
                found = at;
                break;
            }
            --skip;
        }
    }
    vec4 p = positions(found);
    position = vec4(p.x, p.y, p.z, 0.0f);
    power = powers(found);
    direction = directions(found);
}
