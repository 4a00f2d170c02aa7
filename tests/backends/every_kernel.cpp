// Tests that need the library's kernels whole: that devices compile each of them, and one that runs a kernel itself.
// They are apart from the suites of each backend, which an edit of a kernel then does not make stale.
#include "../backend/under_test.hpp"
#include "on_cpu.hpp"
#include "on_gl.hpp"
#include "on_serial.hpp"
#include "on_vulkan.hpp"
#include "vulkan_kernels.hpp"

#include <all_kernels.hpp>
#include <photongrid/render/shade.kernel.hpp>

#include <algorithm>

namespace photongrid::testing {

template <class Tag>
class hard_cases_of_shading : public on_backend<Tag> {
};
using tags = ::testing::Types<serial_tag, cpu_tag, gl_tag, vulkan_tag>;
TYPED_TEST_SUITE(hard_cases_of_shading, tags, tag_names);

TYPED_TEST(hard_cases_of_shading, h2_many_samples_of_a_constant_stay_that_constant)
{
    // shade.glsl adds a share of each sample to the pixel: each addition rounds once, and so does the share.
    auto& b = this->b();
    for (const uint samples : {4096u, 3000u}) {
        const std::vector<glm::vec4> light = {{0.1f, 1.0f / 3, 1000.0f, 0.0f}};
        const auto at = b.upload(std::span<const glm::vec4>(light)),
                   nothing = b.upload(std::span<const glm::vec4>(std::vector<glm::vec4>(1)));
        const auto none = b.upload(std::span<const glm::uvec2>(std::vector<glm::uvec2>(1)));
        auto pixel = b.upload(std::span<const glm::vec4>(std::vector<glm::vec4>(1))),
             searches = b.upload(std::span<const glm::vec4>(std::vector<glm::vec4>(1)));
        for (uint i = 0; i < samples; ++i)
            b.template run<kernels::shade>(1, {.share = 1.0f / static_cast<float>(samples)},
                reads(nothing, nothing, at, nothing, nothing, none), writes(pixel, searches));
        const auto mean = b.download(pixel)[0];
        double largest = 0;
        for (int c = 0; c < 3; ++c)
            largest = std::max(largest, std::abs(static_cast<double>(mean[c]) / static_cast<double>(light[0][c]) - 1));
        this->report("H2_" + std::to_string(samples),
            "mean of " + std::to_string(samples) + " equal samples, relative error:", largest);
        EXPECT_LE(largest, (0.5 * samples + 2) * 0x1p-24); // partial sums are half the whole on the average
    }
}

using kernels_on_gl = on_backend<gl_tag>;

template <class... K>
struct each_kernel {
    static void compile(gl_backend& b)
    {
        (b.compile<K>(0u), ...);
        (b.compile<K>(~0u), ...);
    }
};

TEST_F(kernels_on_gl, compiles_every_kernel_for_every_verb) { all_kernels<each_kernel>::compile(b()); }

// Hard case G6.
TEST(kernels_on_vulkan, every_kernel_compiles_to_valid_spirv_without_contraction)
{
    std::string reason;
    auto* b = shared_backend<vulkan_tag>(reason);
    if (b == nullptr)
        GTEST_SKIP() << reason;
    expect_valid(*b, all_kernels<kernel_list>{});
}

TEST(kernels_on_vulkan, every_kernel_compiles_with_rewritten_arithmetic)
{
    std::string reason;
    if (shared_backend<vulkan_tag>(reason) == nullptr)
        GTEST_SKIP() << reason;
    vulkan_backend rewriting({.arithmetic = arithmetic_kind::rewritten});
    expect_valid(rewriting, all_kernels<kernel_list>{});
}

TEST(kernels_on_vulkan, parameters_stand_where_cpp_has_them)
{
    std::string reason;
    auto* b = shared_backend<vulkan_tag>(reason);
    if (b == nullptr)
        GTEST_SKIP() << reason;
    expect_equal_layouts(*b, all_kernels<kernel_list>{});
    static_assert(sizeof(kernels::Grid) % 16 == 0);
}

} // namespace photongrid::testing
