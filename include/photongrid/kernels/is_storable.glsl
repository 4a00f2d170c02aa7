// True for a diffuse hit that did not come straight from a light, on one of the first `emitted` paths.
#include "photon_event.glsl"

struct Params {
    uint paths;
    uint emitted;
};
PARAMS(Params)
INPUT(0, vec4, positions)

bool holds(uint i)
{
    uint frame = i / args.paths;
    return frame >= 2u && i - frame * args.paths < args.emitted && event_kind(positions(i)) == DIFFUSE_SURFACE;
}
