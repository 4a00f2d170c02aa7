// The eye rays in flight, for a search among meshes. Rays that have ended have length 0.
struct Params {
    uint first; // the eye ray of element 0
};
PARAMS(Params)
INPUT(0, vec4, points)     // w: 0 in flight
INPUT(1, vec4, directions) // xyz: unit vector
OUTPUT(0, vec4, origin)    // xyz, m; w: length
OUTPUT(1, vec4, direction)

void kernel(uint i)
{
    vec4 o = points(args.first + i);
    origin = vec4(o.x, o.y, o.z, o.w == 0.0f ? 3.0e38f : 0.0f);
    direction = directions(args.first + i);
}
