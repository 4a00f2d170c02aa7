// The next rays of a batch of paths, for a search among meshes. Rays of paths that have ended have length 0.
#include <photongrid/trace/photon_event.glsl>

struct Params {
    uint first; // the frame's first element
};
PARAMS(Params)
INPUT(0, vec4, positions)
INPUT(1, vec4, next_origins)
INPUT(2, vec4, next_directions)
OUTPUT(0, vec4, origin)    // xyz, m; w: length
OUTPUT(1, vec4, direction) // xyz: unit vector

void kernel(uint i)
{
    vec4 o = next_origins(args.first + i);
    origin = vec4(o.x, o.y, o.z, event_end(positions(args.first + i)) == GOES_ON ? 3.0e38f : 0.0f);
    direction = next_directions(args.first + i);
}
