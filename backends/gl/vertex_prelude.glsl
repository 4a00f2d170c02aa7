#version 450
// The kernel dialect for the vertex stage: a route kernel says where a point is drawn, so photons are never read back (4.2).
#include "textures.glsl"
#define OUTPUT(B, T, NAME) \
    precise T NAME = T(0); \
    T output_##B() { return NAME; }
