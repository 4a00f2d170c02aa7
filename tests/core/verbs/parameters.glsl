// Every kind of member that parameters have, 112 bytes in all: element i is member i, in the output of its kind.
struct Both {
    vec4 floats;
    uvec4 wholes;
};
struct Params {
    vec4 a;
    uvec4 b;
    Both c;
    vec4 d;
    vec2 e;
    uvec2 f;
    float g;
    uint h;
    int j;
    uint k;
};
PARAMS(Params)
OUTPUT(0, vec4, floats)
OUTPUT(1, uvec4, wholes)

void kernel(uint i)
{
    floats = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    wholes = uvec4(0u, 0u, 0u, 0u);
    if (i == 0u)
        floats = args.a;
    if (i == 1u)
        wholes = args.b;
    if (i == 2u) {
        floats = args.c.floats;
        wholes = args.c.wholes;
    }
    if (i == 3u)
        floats = args.d;
    if (i == 4u)
        floats = vec4(args.e.x, args.e.y, args.g, 0.0f);
    if (i == 5u)
        wholes = uvec4(args.f.x, args.f.y, args.h, args.k);
    if (i == 6u)
        wholes = uvec4(uint(-args.j), args.j < 0 ? 1u : 0u, 0u, 0u);
}
