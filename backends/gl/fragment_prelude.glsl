#version 450
// The kernel dialect for fragment programs: element i is the fragment at its texel; outputs are render targets.
#include "textures.glsl"
// `precise`: so that results equal the serial backend's bit for bit, if the operations round correctly.
#define OUTPUT(B, T, NAME) layout(location = B) precise out T NAME;
// A state's texture is read and written in one pass: each fragment reads its own texel only, which glTextureBarrier
// makes legal (OpenGL 4.5 core, 9.3.1).
#define STATE(B, T, NAME) \
    layout(location = B) precise out T NAME; \
    layout(binding = STATE_UNIT_ + B) uniform SAMPLER_##T NAME##_texture_; \
    void load_state_##B(ivec2 at) { NAME = ELEMENT_##T(texelFetch(NAME##_texture_, at, 0)); }
