#ifndef PHOTONGRID_GL_TEXTURES
#define PHOTONGRID_GL_TEXTURES
// Buffers as textures. Element i is texel (i mod 2048, i / 2048); a texture with fewer elements is one row. Addresses
// use a constant shift and mask, not floats or divisions.
#define SAMPLER_float sampler2D
#define SAMPLER_vec2 sampler2D
#define SAMPLER_vec4 sampler2D
#define SAMPLER_uint usampler2D
#define SAMPLER_uvec2 usampler2D
#define SAMPLER_uvec4 usampler2D
#define ELEMENT_float(v) (v).x
#define ELEMENT_vec2(v) (v).xy
#define ELEMENT_vec4(v) (v)
#define ELEMENT_uint(v) (v).x
#define ELEMENT_uvec2(v) (v).xy
#define ELEMENT_uvec4(v) (v)
ivec2 texel_(uint i) { return ivec2(int(i & 2047u), int(i >> 11u)); }
#define INPUT(B, T, NAME) \
    layout(binding = B) uniform SAMPLER_##T NAME##_texture_; \
    T NAME(uint i) { return ELEMENT_##T(texelFetch(NAME##_texture_, texel_(i), 0)); }

#define inline
#define PARAMS(P) layout(std140, binding = 0) uniform args_block_ { P args; };
#define SWITCH(B, NAME) const bool NAME = ((SWITCHES_ >> B) & 1u) != 0u;
// Groups have one element.
#define IN_GROUPS(B)
#define GROUP_LANES 1u
#define EACH_LANE(F) F(0u);
uint group_lane() { return 0u; }
bool group_any(bool b) { return b; }
uint group_min(uint v) { return v; }
uint group_max(uint v) { return v; }
uint group_sum_up_to(uint v) { return v; }
#define lane_value(V, LANE) (V)
#define LANE_VARIABLE(T, NAME) T NAME;
#define begin_lanes()
#define end_lanes()
#define set_lane(NAME, V) NAME = V
#define from_lane(NAME, LANE) NAME
layout(location = 0) uniform uvec4 launch_; // first element, number of elements; unused
#endif
