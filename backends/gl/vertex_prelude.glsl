#version 450
// The kernel dialect for the vertex stage: a route kernel computes where a point is drawn, so photons are not read back
// (4.2).
#include "textures.glsl"
#define OUTPUT(B, T, NAME) \
    precise T NAME = T(0); \
    T output_##B() { return NAME; }
