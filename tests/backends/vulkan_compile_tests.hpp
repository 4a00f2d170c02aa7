// Kernels as compiled by the Vulkan backend.
#pragma once

#include "vulkan_under_test.hpp"

namespace photongrid::testing {

TEST_F(vulkan, a_kernels_error_names_its_file_and_line)
{
    auto out = b().make<uint>(1);
    try {
        b().run<test_kernels::broken>(1, {}, reads(), writes(out));
        FAIL() << "a broken kernel compiled";
    } catch (const backend_error& e) {
        const std::string text = e.what();
        EXPECT_NE(text.find("test/broken.glsl:8: error:"), std::string::npos) << text;
        EXPECT_NE(text.find("result = i * 2.5f;"), std::string::npos) << text;
    }
}

using test_kernel_list = kernel_list<test_kernels::contracts, test_kernels::countdown, test_kernels::eight_states>;

// The library's kernels are looked at so in on_vulkan.cpp.
TEST_F(vulkan, every_kernel_compiles_to_valid_spirv_without_contraction) { expect_valid(b(), test_kernel_list{}); }

TEST_F(vulkan, parameters_stand_where_cpp_has_them)
{
    expect_equal_layouts(b(), test_kernel_list{});
    struct astray { // as it must not be: GLSL aligns uvec2 to 8 bytes, GLM to 4
        uint a;
        glm::uvec2 b;
    };
    EXPECT_EQ(testing::offsets_in_cpp(astray{}), (std::vector<std::size_t>{0, 4}));
}

TEST_F(vulkan, a_switch_that_is_off_leaves_no_code)
{
    const auto size = [&](uint switches) {
        return photongrid::vulkan::count_instructions(b().spirv<test_kernels::switched>(switches));
    };
    const auto neither = size(0);
    EXPECT_LT(neither, size(1));
    EXPECT_LT(neither, size(1u << 5));
    EXPECT_LT(size(1), size(~0u));
    const auto loops = [&](uint switches) {
        std::size_t n = 0;
        photongrid::vulkan::for_each_instruction(b().spirv<test_kernels::switched>(switches),
            [&](std::uint32_t op, std::size_t, std::size_t) { n += op == 246 ? 1u : 0u; }); // OpLoopMerge
        return n;
    };
    EXPECT_EQ(loops(0), 0u);
    EXPECT_EQ(loops(1), 1u);
    EXPECT_EQ(loops(~0u), 2u);
    EXPECT_EQ(size(~0u), size(33u)); // switches that the kernel lacks change nothing
    const auto run = [&](auto& backend, uint switches) {
        auto out = backend.template make<uint>(100);
        backend.template run<test_kernels::switched>({100, 0u, switches}, {.factor = 3}, reads(), writes(out));
        return backend.download(out);
    };
    for (const uint switches : {0u, 1u, 32u, ~0u})
        EXPECT_EQ(run(b(), switches), run(serial, switches)) << switches;
}

// --- devices
// ----------------------------------------------------------------------------------------------------------

} // namespace photongrid::testing
