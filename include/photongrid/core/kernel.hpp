// A kernel in C++: a struct that includes a kernel file between core/begin.hpp and core/end.hpp. The templates
// here find its parameters, inputs and outputs at compile time, so that a call with the wrong buffers does not compile.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <string_view>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// 32 bits, as in GLSL.
using uint = std::uint32_t;

/// The index of an input, output or switch, as a type.
template <std::size_t I>
struct slot {
    static constexpr std::size_t index = I; ///< I
};

/// An element type of buffers: one that GLSL, C++ and textures lay out alike (4, 8 or 16 bytes).
template <class T>
concept element = std::same_as<T, float> || std::same_as<T, uint> || std::same_as<T, glm::vec2> || std::same_as<T,
    glm::uvec2> || std::same_as<T, glm::vec4> || std::same_as<T, glm::uvec4>;

namespace detail {
    template <class K, std::size_t I = 0>
    consteval std::size_t count_inputs()
    {
        if constexpr (requires { K::input_type(slot<I>{}); })
            return count_inputs<K, I + 1>();
        else
            return I;
    }

    template <class K, std::size_t I = 0>
    consteval std::size_t count_outputs()
    {
        if constexpr (requires { K::is_state(slot<I>{}); })
            return count_outputs<K, I + 1>();
        else
            return I;
    }
} // namespace detail

namespace detail {
    /// What a guarded read past the end of a buffer gives (PHOTONGRID_GUARD_READS).
    template <element T>
    inline constexpr T no_element{};

    template <class F, std::size_t... I>
    [[gnu::always_inline]] constexpr void for_each_slot(const F& f, std::index_sequence<I...>)
    {
        (f(slot<I>{}), ...);
    }
    /// Calls f(slot<0>{}), ..., f(slot<N - 1>{}).
    template <std::size_t N, class F>
    [[gnu::always_inline]] constexpr void for_each_slot(const F& f)
    {
        for_each_slot(f, std::make_index_sequence<N>{});
    }
} // namespace detail

/// The number of INPUTs that kernel K declares. Slots are numbered from 0 without gaps.
template <class K>
inline constexpr std::size_t input_count = detail::count_inputs<K>();
/// The number of OUTPUTs and STATEs that kernel K declares. They are numbered together.
template <class K>
inline constexpr std::size_t output_count = detail::count_outputs<K>();

/// The element type of input slot I of kernel K.
template <class K, std::size_t I>
using input_t = decltype(K::input_type(slot<I>{}));
/// The element type of output or state slot I of kernel K.
template <class K, std::size_t I>
using output_t = std::remove_reference_t<decltype(std::declval<K&>().output(slot<I>{}))>;

// Not formatted: clang-format 14 breaks each of these lines in three.
// clang-format off
/// A kernel: a source text with parameters and slots.
template <class K>
concept kernel_struct = std::default_initializable<K> && std::default_initializable<typename K::Params>
    && requires(K k) {
    { K::path } -> std::convertible_to<std::string_view>;
    { k.args } -> std::same_as<typename K::Params&>;
};

/// A gather kernel: `kernel(i)` computes element i of every output and touches nothing else.
template <class K>
concept gather_kernel = kernel_struct<K> && requires(K k, uint i) { k.kernel(i); };

/// A gather kernel with a function done(), which says whether an element needs no more passes.
template <class K>
concept iterative_kernel = gather_kernel<K> && requires(K k) { { k.done() } -> std::same_as<bool>; };

/// A predicate over elements: `holds(i)`.
template <class K>
concept predicate_kernel = kernel_struct<K> && requires(K k, uint i) { { k.holds(i) } -> std::same_as<bool>; };

/// A routing kernel: draw i has a destination (none: `no_id`), a payload, and an amount that is added to the
/// destination's total.
template <class K>
concept route_kernel = gather_kernel<K> && output_count<K> == 3 && std::same_as<output_t<K, 0>, uint>
    && std::same_as<output_t<K, 1>, uint> && std::same_as<output_t<K, 2>, glm::vec4>;

// clang-format on

/// The kernel's name: its file's name without folder and extension, "bitonic_step".
template <kernel_struct K>
constexpr std::string_view kernel_name()
{
    std::string_view path = K::path;
    path.remove_prefix(path.find_last_of("/\\") + 1); // npos + 1 is 0
    return path.substr(0, path.find_last_of('.'));
}

/// The SWITCHes that kernel K declares, as bits (bit B is slot B).
template <kernel_struct K>
constexpr uint known_switches()
{
    uint known = 0;
    detail::for_each_slot<32>([&]([[maybe_unused]] auto s) {
        if constexpr (requires(K & k) { k.turn(s, true); })
            known |= 1u << s.index;
    });
    return known;
}

/// Sets the SWITCHes of `k` to the bits of `switches` (bit B is slot B). Bits without a SWITCH are ignored.
template <kernel_struct K>
void turn_switches(K& k, uint switches)
{
    detail::for_each_slot<32>([&]([[maybe_unused]] auto s) {
        if constexpr (requires { k.turn(s, true); })
            k.turn(s, ((switches >> s.index) & 1u) != 0u);
    });
}

namespace kernels {
    using namespace glm; // GLSL's types and functions
} // namespace kernels

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
