// The kernel dialect read as C++. Include this, then kernel files inside structs, then core/end.hpp.
//
// A kernel file is both GLSL 4.50 and C++20 (docs/design/design.md). It declares its inputs and outputs with the macros
// below and defines `void kernel(uint i)`, which computes element i. The GL and Vulkan preludes define the same macros.
//
//   PARAMS(P)             the struct P of uniform values, visible as `args`
//   INPUT(B, T, NAME)     a read-only buffer at input slot B; NAME(i) is its element i
//   OUTPUT(B, T, NAME)    the variable NAME is written to element i of the buffer at output slot B
//   STATE(B, T, NAME)     like OUTPUT, but NAME holds the element's old value before `kernel` runs: in place
//   SWITCH(B, NAME)       a bool that is constant during a pass; on GPUs a compile-time constant, so `if (NAME)` is
//                         free. In C++, NAME_switch is its bit of launch::switches.
//   IN_GROUPS(B)          the kernel may use subgroup operations. If the device has them and switch B is on,
//                         GROUP_LANES elements run together in a subgroup; otherwise, and always in C++ and on GL,
//                         GROUP_LANES is 1. Incomplete groups repeat their last element; the duplicate result is
//                         discarded.
//     group_lane()        index of this lane
//     group_any(b)        true if b is true in any lane
//     group_min(v)        smallest v of all lanes; group_max(v): largest
//     group_sum_up_to(v)  inclusive prefix sum of v over the lanes
//     lane_value(v, n)    v of lane n
//     EACH_LANE(F)        F(0u) to F(GROUP_LANES - 1u)
//     LANE_VARIABLE(T, NAME)
//                         a variable that each lane sets and all lanes read, declared outside of functions
//     set_lane(NAME, v)   sets this lane's; between begin_lanes() and end_lanes()
//     from_lane(NAME, LANE)
//                         that of the LANE of an EACH_LANE; after end_lanes()
//                         Subgroup operations must be in uniform control flow: not in a branch, nor in an operand of
//                         ?:, that only some of the lanes execute.
//
// No include guard: every header with kernels includes this file again.
#include <cassert>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/integer.hpp>
#include <photongrid/core/kernel.hpp>
#include <photongrid/core/text_file.hpp>
#include <span>
#include <string_view>

// Kernels name the parameter i even where they do not use it: Mesa rejects unnamed parameters.
#include <photongrid/core/exact_begin.hpp>
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

// NOLINTBEGIN
// Saves macros of the same names that the including file may have; end.hpp restores them. The list has every macro that
// a kernel file defines or undefines.
#pragma push_macro("PARAMS")
#undef PARAMS
#pragma push_macro("INPUT")
#undef INPUT
#pragma push_macro("OUTPUT")
#undef OUTPUT
#pragma push_macro("STATE")
#undef STATE
#pragma push_macro("SWITCH")
#undef SWITCH
#pragma push_macro("GROUP_LANES")
#undef GROUP_LANES
#pragma push_macro("EACH_LANE")
#undef EACH_LANE
#pragma push_macro("LANE_VARIABLE")
#undef LANE_VARIABLE
#pragma push_macro("IN_GROUPS")
#undef IN_GROUPS
#pragma push_macro("VISIT")
#undef VISIT
#pragma push_macro("PHOTON_OF")
#undef PHOTON_OF
#pragma push_macro("EACH_PHOTON")
#undef EACH_PHOTON
#pragma push_macro("precise")
#undef precise

// Defined while a kernel file is included inside its struct. Shared files then expand to nothing, because C++ has
// already included them at namespace scope (cmake/kernel_headers.cmake); GLSL splices each in once (kernel_source.hpp).
#define PHOTONGRID_INSIDE_KERNEL_STRUCT

#define PARAMS(P)                                                                                                      \
    P args{};                                                                                                          \
    static constexpr std::string_view path = __FILE__;

// Kernels read where ids of earlier passes point. With PHOTONGRID_GUARD_READS a read past the end of a buffer gives 0;
// all files of a program must agree on it (the CMake option of that name sees to that). Without, it is asserted that
// there is none.
#ifdef PHOTONGRID_GUARD_READS
#define PHOTONGRID_ELEMENT(T, NAME)                                                                                    \
    return i < NAME##_data.size() ? NAME##_data[i] : ::photongrid::detail::no_element<T>;
#else
#define PHOTONGRID_ELEMENT(T, NAME)                                                                                    \
    assert(i < NAME##_data.size() && "kernel reads past the end of " #NAME);                                           \
    return NAME##_data[i];
#endif

#define INPUT(B, T, NAME)                                                                                              \
    std::span<const T> NAME##_data{};                                                                                  \
    const T& NAME(::photongrid::uint i) const { PHOTONGRID_ELEMENT(T, NAME) }                                          \
    static T input_type(::photongrid::slot<B>);                                                                        \
    static constexpr std::string_view input_name(::photongrid::slot<B>) { return #NAME; }                              \
    void bind(::photongrid::slot<B>, std::span<const T> data) { NAME##_data = data; }

#define PHOTONGRID_VARIABLE(B, T, NAME, IS_STATE)                                                                      \
    T NAME{};                                                                                                          \
    T& output(::photongrid::slot<B>) { return NAME; }                                                                  \
    static constexpr std::string_view output_name(::photongrid::slot<B>) { return #NAME; }                             \
    static constexpr bool is_state(::photongrid::slot<B>) { return IS_STATE; }

#define OUTPUT(B, T, NAME) PHOTONGRID_VARIABLE(B, T, NAME, false)
#define STATE(B, T, NAME) PHOTONGRID_VARIABLE(B, T, NAME, true)

#define SWITCH(B, NAME)                                                                                                \
    bool NAME = true;                                                                                                  \
    static constexpr ::photongrid::uint NAME##_switch = 1u << B;                                                       \
    void turn(::photongrid::slot<B>, bool on) { NAME = on; }

#define GROUP_LANES 1u
#define EACH_LANE(F) F(0u);
#define LANE_VARIABLE(T, NAME) T NAME;
#define IN_GROUPS(B)                                                                                                   \
    static constexpr ::photongrid::uint group_switch = B;                                                              \
    void turn(::photongrid::slot<B>, bool) {}                                                                          \
    static constexpr ::photongrid::uint group_lane() { return 0; }                                                     \
    static constexpr bool group_any(bool b) { return b; }                                                              \
    static constexpr ::photongrid::uint group_min(::photongrid::uint v) { return v; }                                  \
    static constexpr ::photongrid::uint group_max(::photongrid::uint v) { return v; }                                  \
    static constexpr ::photongrid::uint group_sum_up_to(::photongrid::uint v) { return v; }                            \
    static constexpr auto lane_value(const auto& v, ::photongrid::uint) { return v; }                                  \
    static constexpr void begin_lanes() {}                                                                             \
    static constexpr void end_lanes() {}                                                                               \
    static constexpr void set_lane(auto& lane, const auto& v) { lane = v; }                                            \
    static constexpr auto from_lane(const auto& v, ::photongrid::uint) { return v; }

#define precise
// NOLINTEND
