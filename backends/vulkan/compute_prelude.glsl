#version 450
// The kernel dialect for Vulkan compute shaders, with one invocation per element. The backend defines, before this
// file:
//   GROUP      invocations in a workgroup      SWITCHES   the bits of launch.switches
//   OUTPUTS    how many OUTPUTs and STATEs the kernel has
//   LANES      elements per group in kernels that are IN_GROUPS: a subgroup's invocations, or 1
//   LANE_LOOPS 1: EACH_LANE is a loop, and LANE_VARIABLEs are in memory that a workgroup shares; 0: for lavapipe
//              EACH_LANE is unrolled, so that lanes are constants, and LANE_VARIABLEs are passed by shuffles
//   TEXELS     1: inputs are read as texel buffers, 0: as storage buffers
//   FIRST_OUTPUT, FIRST_OWN: see Bindings
// Bindings: inputs from 0, outputs and states from FIRST_OUTPUT, the verb's own from FIRST_OWN. No buffer is
// `restrict`, because a pass may read one frame of a buffer and write another.
#if LANES > 1
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_basic : require
#endif
#define inline
// `precise` is not needed, because every float operation gets NoContraction in the SPIR-V (spirv.hpp). And glslang 12
// loops until it is out of memory if precise values depend on each other in a cycle (eye_bounce.glsl).
#define precise
layout(local_size_x = GROUP) in;

// launch_.x: elements, y: first element, z: workgroups, w: index of the first element's outputs. The parameters come
// last, because members after a nested struct are padded differently in std430 and C++.
#define PARAMS(P) layout(push_constant) uniform launch_block_ { uvec4 launch_; P args; };

#if TEXELS
// lavapipe reads texels with vector loads, but storage buffers word by word and lane by lane.
#define BUFFER_float samplerBuffer
#define BUFFER_vec2 samplerBuffer
#define BUFFER_vec4 samplerBuffer
#define BUFFER_uint usamplerBuffer
#define BUFFER_uvec2 usamplerBuffer
#define BUFFER_uvec4 usamplerBuffer
#define INPUT(B, T, NAME)                                                                    \
    layout(binding = B) uniform BUFFER_##T NAME##_data_;                                     \
    T NAME(uint i) { return T(texelFetch(NAME##_data_, int(i))); }
#else
#define INPUT(B, T, NAME)                                                                    \
    layout(std430, binding = B) readonly buffer NAME##_block_ { T NAME##_data_[]; };         \
    T NAME(uint i) { return NAME##_data_[i]; }
#endif

#define OUTPUT(B, T, NAME)                                                                   \
    T NAME;                                                                                  \
    layout(std430, binding = FIRST_OUTPUT + B) buffer NAME##_block_ { T NAME##_data_[]; };              \
    void load_##B(uint i) { NAME = T(0); }                                                   \
    void store_##B(uint i) { NAME##_data_[i] = NAME; }

#define STATE(B, T, NAME)                                                                    \
    T NAME;                                                                                  \
    layout(std430, binding = FIRST_OUTPUT + B) buffer NAME##_block_ { T NAME##_data_[]; };              \
    void load_##B(uint i) { NAME = NAME##_data_[i]; }                                        \
    void store_##B(uint i) { NAME##_data_[i] = NAME; }

#define SWITCH(B, NAME) const bool NAME = ((SWITCHES >> B) & 1u) != 0u;

#define IN_GROUPS(B)
#if LANES > 1
const uint GROUP_LANES = uint(LANES);
uint group_lane() { return gl_SubgroupInvocationID; }
#define lane_value(V, LANE) subgroupShuffle(V, LANE)
#if LANE_LOOPS
// A shuffle passes one word; a read of shared memory passes four.
#define LANE_VARIABLE(T, NAME) shared T NAME[GROUP];
uint first_lane_() { return gl_SubgroupID * GROUP_LANES; }
void begin_lanes() { subgroupBarrier(); }
void end_lanes()
{
    subgroupMemoryBarrierShared();
    subgroupBarrier();
}
#define set_lane(NAME, V) NAME[first_lane_() + gl_SubgroupInvocationID] = V
#define from_lane(NAME, LANE) NAME[first_lane_() + (LANE)]
#else
#define LANE_VARIABLE(T, NAME) T NAME;
#define begin_lanes()
#define end_lanes()
#define set_lane(NAME, V) NAME = V
#define from_lane(NAME, LANE) subgroupShuffle(NAME, LANE)
#endif
#if LANE_LOOPS
uint group_min(uint v) { return subgroupMin(v); }
uint group_max(uint v) { return subgroupMax(v); }
uint group_sum_up_to(uint v) { return subgroupInclusiveAdd(v); }
#define EACH_LANE(F) for (uint lane_ = 0u; lane_ < GROUP_LANES; ++lane_) { F(lane_); }
#else
// lavapipe shuffles with one instruction if the lanes are constants, and does everything else lane by lane.
uint from_xor_(uint v, uint places) { return subgroupShuffle(v, gl_SubgroupInvocationID ^ places); }
uint from_below_(uint v, uint places)
{
    uint below = subgroupShuffle(v, max(gl_SubgroupInvocationID, places) - places);
    return gl_SubgroupInvocationID < places ? 0u : below;
}
uint group_min(uint v)
{
    v = min(v, from_xor_(v, 1u));
    v = min(v, from_xor_(v, 2u));
#if LANES == 8
    v = min(v, from_xor_(v, 4u));
#endif
    return v;
}
uint group_max(uint v) { return ~group_min(~v); }
uint group_sum_up_to(uint v)
{
    v += from_below_(v, 1u);
    v += from_below_(v, 2u);
#if LANES == 8
    v += from_below_(v, 4u);
#endif
    return v;
}
#define EACH_LANE_4(F, L) F(L); F(L + 1u); F(L + 2u); F(L + 3u);
#if LANES == 8
#define EACH_LANE(F) EACH_LANE_4(F, 0u) EACH_LANE_4(F, 4u)
#else
#define EACH_LANE(F) EACH_LANE_4(F, 0u)
#endif
#endif
bool group_any(bool b) { return group_max(b ? 1u : 0u) != 0u; }
#else
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
#endif

#if OUTPUTS > 8
#error a kernel has more than 8 outputs and states
#endif
// The calls of each kernel's load_B and store_B, for the verbs.
#define EACH_1(F, i) F##0(i);
#define EACH_2(F, i) EACH_1(F, i) F##1(i);
#define EACH_3(F, i) EACH_2(F, i) F##2(i);
#define EACH_4(F, i) EACH_3(F, i) F##3(i);
#define EACH_5(F, i) EACH_4(F, i) F##4(i);
#define EACH_6(F, i) EACH_5(F, i) F##5(i);
#define EACH_7(F, i) EACH_6(F, i) F##6(i);
#define EACH_8(F, i) EACH_7(F, i) F##7(i);
#if OUTPUTS == 0
#define LOAD_ALL(i)
#define STORE_ALL(i)
#elif OUTPUTS == 1
#define LOAD_ALL(i) EACH_1(load_, i)
#define STORE_ALL(i) EACH_1(store_, i)
#elif OUTPUTS == 2
#define LOAD_ALL(i) EACH_2(load_, i)
#define STORE_ALL(i) EACH_2(store_, i)
#elif OUTPUTS == 3
#define LOAD_ALL(i) EACH_3(load_, i)
#define STORE_ALL(i) EACH_3(store_, i)
#elif OUTPUTS == 4
#define LOAD_ALL(i) EACH_4(load_, i)
#define STORE_ALL(i) EACH_4(store_, i)
#elif OUTPUTS == 5
#define LOAD_ALL(i) EACH_5(load_, i)
#define STORE_ALL(i) EACH_5(store_, i)
#elif OUTPUTS == 6
#define LOAD_ALL(i) EACH_6(load_, i)
#define STORE_ALL(i) EACH_6(store_, i)
#elif OUTPUTS == 7
#define LOAD_ALL(i) EACH_7(load_, i)
#define STORE_ALL(i) EACH_7(store_, i)
#else
#define LOAD_ALL(i) EACH_8(load_, i)
#define STORE_ALL(i) EACH_8(store_, i)
#endif

// The number of this workgroup, and of this invocation. Workgroups have two dimensions, because one is limited to
// 65,535.
uint group_() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
uint element_() { return group_() * uint(GROUP) + gl_LocalInvocationIndex; }
