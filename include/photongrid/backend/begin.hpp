// The kernel dialect read as C++. Include this, then kernel files inside structs, then backend/end.hpp.
//
// A kernel file is GLSL 4.50 and C++20 at once (docs/design/design.md). It declares, with the words below, what it
// reads and writes, and defines `void kernel(uint i)`, which computes element i. GL and Vulkan define the same words
// their way.
//
//   PARAMS(P)             the struct P of uniform values, visible as `args`
//   INPUT(B, T, NAME)     a read-only buffer at input slot B; NAME(i) is its element i
//   OUTPUT(B, T, NAME)    the variable NAME is written to element i of the buffer at output slot B
//   STATE(B, T, NAME)     like OUTPUT, but NAME holds the element's old value before `kernel` runs: in place
//   SWITCH(B, NAME)       a bool, constant while a pass runs; compiled in on GPUs, so that `if (NAME)` costs nothing
//   IN_GROUPS(B)          elements may be computed GROUP_LANES at a time, in step, and tell each other what they hold,
//   where
//                         the device can and switch B is on; else, and always here and on GL, one by one. group_lane()
//                         is this element's place among them; group_any(b), group_min(v), group_max(v) are over all,
//                         group_sum_up_to(v) over the places up to this one; lane_value(v, place) is v there;
//                         EACH_LANE(F) says F(0u) to F(GROUP_LANES - 1u), and from_lane(v, LANE) is for its LANE. Some
//                         of a group may be the same element. Ask others only where all of a group do: not in a branch,
//                         nor in an arm of ?:, that some of them do not take.
//
// No include guard: this file is meant to be read again by every header that holds kernels.
#include <cassert>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/integer.hpp>
#include <photongrid/backend/kernel.hpp>
#include <photongrid/backend/text_file.hpp>
#include <span>
#include <string_view>

// A kernel that needs no index names its parameter all the same: Mesa takes no unnamed one.
#include <photongrid/backend/exact_begin.hpp>
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

// NOLINTBEGIN
// A macro of the same name that your file has is put aside here and comes back with end.hpp.
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
#pragma push_macro("IN_GROUPS")
#undef IN_GROUPS
#pragma push_macro("PHOTON_OF")
#undef PHOTON_OF
#pragma push_macro("EACH_PHOTON")
#undef EACH_PHOTON
#pragma push_macro("precise")
#undef precise

// Files that kernels share are spliced into GLSL once (kernel_source.hpp). C++ reads them at namespace scope, by their
// own headers (cmake/kernel_headers.cmake); within a kernel's struct they are then empty.
#define PHOTONGRID_SHARED_IS_READ

#define PARAMS(P)                                                                                                      \
    P args{};                                                                                                          \
    static constexpr std::string_view path = __FILE__;

#define INPUT(B, T, NAME)                                                                                              \
    std::span<const T> NAME##_data{};                                                                                  \
    const T& NAME(::photongrid::uint i) const                                                                          \
    {                                                                                                                  \
        assert(i < NAME##_data.size() && "kernel reads past the end of " #NAME);                                       \
        return NAME##_data[i];                                                                                         \
    }                                                                                                                  \
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
    void turn(::photongrid::slot<B>, bool on) { NAME = on; }

#define GROUP_LANES 1u
#define EACH_LANE(F) F(0u);
#define IN_GROUPS(B)                                                                                                   \
    static constexpr ::photongrid::uint group_switch = B;                                                              \
    void turn(::photongrid::slot<B>, bool) {}                                                                          \
    static constexpr ::photongrid::uint group_lane() { return 0; }                                                     \
    static constexpr bool group_any(bool b) { return b; }                                                              \
    static constexpr ::photongrid::uint group_min(::photongrid::uint v) { return v; }                                  \
    static constexpr ::photongrid::uint group_max(::photongrid::uint v) { return v; }                                  \
    static constexpr ::photongrid::uint group_sum_up_to(::photongrid::uint v) { return v; }                            \
    static constexpr auto lane_value(const auto& v, ::photongrid::uint) { return v; }                                  \
    static constexpr auto from_lane(const auto& v, ::photongrid::uint) { return v; }

#define precise
// NOLINTEND
