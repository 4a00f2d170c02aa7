// What SPIR-V is made of kernels: valid, nothing to contract, parameters where C++ has them.
#pragma once

#include "params_layout.hpp"

#include <photongrid/backends/vulkan/vulkan.hpp>

#include <gtest/gtest.h>
#include <spirv-tools/libspirv.hpp>

#include <set>

namespace photongrid::testing {

template <class... K>
struct kernel_list {
};

/// Every float operation of a module that lacks NoContraction.
inline std::size_t free_to_contract(const std::vector<std::uint32_t>& words)
{
    std::set<std::uint32_t> decorated;
    std::size_t n = 0;
    photongrid::vulkan::for_each_instruction(words, [&](std::uint32_t op, std::size_t at, std::size_t) {
        if (op == 71 && words[at + 2] == 42)
            decorated.insert(words[at + 1]);
        if (op == 127 || op == 129 || op == 131 || op == 133 || op == 136 || op == 142)
            n += decorated.count(words[at + 2]) == 0 ? 1u : 0u;
    });
    return n;
}

template <class... K>
void expect_valid(vulkan_backend& b, kernel_list<K...>)
{
    spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_1);
    std::string complaints;
    tools.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t&, const char* m) {
        complaints += std::string(m) + "\n";
    });
    const auto check = [&](std::string_view name, const std::vector<std::uint32_t>& words) {
        complaints.clear();
        EXPECT_TRUE(tools.Validate(words)) << name << ": " << complaints;
        EXPECT_EQ(free_to_contract(words), 0u) << name;
        EXPECT_GT(photongrid::vulkan::count_instructions(words), 0u) << name;
    };
    const auto one = [&]<class Kernel>(std::type_identity<Kernel>) {
        for (const uint switches : {~0u, 0u})
            check(kernel_name<Kernel>(), b.spirv<Kernel>(switches));
        if constexpr (iterative_kernel<Kernel>)
            check(kernel_name<Kernel>(), b.iterate_spirv<Kernel>());
        EXPECT_GT(b.costs().at(std::string(kernel_name<Kernel>())).instructions, 0u);
        EXPECT_GT(b.costs().at(std::string(kernel_name<Kernel>())).compile_ms, 0.0);
    };
    (one(std::type_identity<K>{}), ...);
}

// Params are passed as bytes, to GL too: std140 and std430 place scalars, vectors and structs of whole 16 bytes alike.
template <class... K>
void expect_equal_layouts(vulkan_backend& b, kernel_list<K...>)
{
    std::size_t compared = 0;
    const auto one = [&]<class Kernel>(std::type_identity<Kernel>) {
        const auto in_spirv = testing::offsets_in_spirv(b.spirv<Kernel>(~0u));
        if (in_spirv.empty())
            return; // reads no parameter
        EXPECT_EQ(testing::offsets_in_cpp(typename Kernel::Params{}), in_spirv) << kernel_name<Kernel>();
        ++compared;
    };
    (one(std::type_identity<K>{}), ...);
    EXPECT_GT(compared, (sizeof...(K) - 1) / 2);
}

} // namespace photongrid::testing
