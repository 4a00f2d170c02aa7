// True for a path that continues after this surface.
#include <photongrid/trace/photon_event.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, positions)

bool holds(uint i)
{
    return event_end(positions(i)) == GOES_ON;
}
