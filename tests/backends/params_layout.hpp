// Offsets of the members of a kernel's Params: in C++, by taking the struct apart, and in its SPIR-V.
#pragma once

#include <photongrid/backends/vulkan/spirv.hpp>

#include <cstddef>
#include <map>
#include <type_traits>
#include <vector>

namespace photongrid::testing {

namespace params_detail {
    /// Initialises a member of any type.
    struct anything {
        template <class T>
        operator T() const;
    };

    template <class T, class... Members>
    consteval std::size_t member_count()
    {
        if constexpr (requires { T{Members{}..., anything{}}; })
            return member_count<T, Members..., anything>();
        else
            return sizeof...(Members);
    }

    template <class T, class F>
    void for_each_member(const T& t, F f)
    {
        constexpr auto n = member_count<T>();
        static_assert(n >= 1 && n <= 12, "Params with more members: add a line here");
        const auto all = [&](const auto&... m) { (f(m), ...); };
        if constexpr (n == 1) {
            const auto& [a] = t;
            all(a);
        }
        if constexpr (n == 2) {
            const auto& [a, b] = t;
            all(a, b);
        }
        if constexpr (n == 3) {
            const auto& [a, b, c] = t;
            all(a, b, c);
        }
        if constexpr (n == 4) {
            const auto& [a, b, c, d] = t;
            all(a, b, c, d);
        }
        if constexpr (n == 5) {
            const auto& [a, b, c, d, e] = t;
            all(a, b, c, d, e);
        }
        if constexpr (n == 6) {
            const auto& [a, b, c, d, e, g] = t;
            all(a, b, c, d, e, g);
        }
        if constexpr (n == 7) {
            const auto& [a, b, c, d, e, g, h] = t;
            all(a, b, c, d, e, g, h);
        }
        if constexpr (n == 8) {
            const auto& [a, b, c, d, e, g, h, i] = t;
            all(a, b, c, d, e, g, h, i);
        }
        if constexpr (n == 9) {
            const auto& [a, b, c, d, e, g, h, i, j] = t;
            all(a, b, c, d, e, g, h, i, j);
        }
        if constexpr (n == 10) {
            const auto& [a, b, c, d, e, g, h, i, j, k] = t;
            all(a, b, c, d, e, g, h, i, j, k);
        }
        if constexpr (n == 11) {
            const auto& [a, b, c, d, e, g, h, i, j, k, l] = t;
            all(a, b, c, d, e, g, h, i, j, k, l);
        }
        if constexpr (n == 12) {
            const auto& [a, b, c, d, e, g, h, i, j, k, l, m12] = t;
            all(a, b, c, d, e, g, h, i, j, k, l, m12);
        }
    }
} // namespace params_detail

/// Offsets (bytes) of the scalars and vectors of an aggregate, those of nested structs too, in order.
template <class T>
std::vector<std::size_t> offsets_in_cpp(const T& t)
{
    std::vector<std::size_t> offsets;
    params_detail::for_each_member(t, [&]<class M>(const M& m) {
        const auto at
            = static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&m) - reinterpret_cast<const std::byte*>(&t));
        if constexpr (element<M>)
            offsets.push_back(at);
        else
            for (const auto inner : offsets_in_cpp(m))
                offsets.push_back(at + inner);
    });
    return offsets;
}

/// The same of the Params in a module's push constant block, whose first member is the backend's own. Empty when the
/// kernel reads none of them.
inline std::vector<std::size_t> offsets_in_spirv(const photongrid::vulkan::spirv_words& words)
{
    constexpr std::uint32_t type_struct = 30, type_pointer = 32, variable = 59, member_decorate = 72, push_constant = 9,
                            offset = 35;
    std::map<std::uint32_t, std::vector<std::uint32_t>> members;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> places; // (struct, member)
    std::map<std::uint32_t, std::uint32_t> pointees;
    std::uint32_t block = 0;
    photongrid::vulkan::for_each_instruction(words, [&](std::uint32_t op, std::size_t at, std::size_t length) {
        if (op == type_struct)
            members[words[at + 1]].assign(words.begin() + static_cast<std::ptrdiff_t>(at + 2),
                words.begin() + static_cast<std::ptrdiff_t>(at + length));
        if (op == member_decorate && words[at + 3] == offset)
            places[{words[at + 1], words[at + 2]}] = words[at + 4];
        if (op == type_pointer)
            pointees[words[at + 1]] = words[at + 3];
        if (op == variable && words[at + 3] == push_constant)
            block = pointees.at(words[at + 1]);
    });
    std::vector<std::size_t> offsets;
    const auto walk = [&](const auto& self, std::uint32_t type, std::size_t base) -> void {
        if (!members.contains(type)) {
            offsets.push_back(base);
            return;
        }
        for (std::uint32_t m = 0; m < members[type].size(); ++m)
            self(self, members[type][m], base + places.at({type, m}));
    };
    if (block != 0 && members.at(block).size() > 1) {
        const auto params = members.at(block)[1];
        walk(walk, params, 0);
    }
    return offsets;
}

} // namespace photongrid::testing
