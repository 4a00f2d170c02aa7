// Tests that need the library's kernels whole: that devices compile each of them, and one that runs a kernel itself.
// They are apart from the suites of each backend, which an edit of a kernel then does not make stale.
#include "../core/under_test.hpp"
#include "on_cpu.hpp"
#include "on_gl.hpp"
#include "on_serial.hpp"
#include "on_vulkan.hpp"
#include "vulkan_kernels.hpp"

#include <all_kernels.hpp>
#include <photongrid/render/add_gathered.kernel.hpp>
#include <photongrid/render/shade.kernel.hpp>
#include <photongrid/render/shade_bias.kernel.hpp>

#include <algorithm>
#include <numbers>

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

TYPED_TEST(hard_cases_of_shading, look_ups_of_a_final_gather_equal_their_formula)
{
    // Two photons: irradiances 1, 2, 4 and 8, squared radii 0.04 and 1.
    struct ray {
        glm::vec4 start, end;
        float surfaces;
        uint nearest;
        float distance2;
        glm::vec3 added; // to the irradiance, for the weights, throughputs and share below
        float left;      // w of the end after the pass
    };
    constexpr uint none = 0xFFFFFFFFu;
    const glm::vec4 origin(0, 0, 0, 1);
    const ray rays[] = {
        {origin, {1, 0, 0, 1}, 0, 0, 0.01f, {1, 2, 4}, -1},        // far: looked up
        {origin, {1, 0, 0, 1}, 0, 0, 0.16f, {0.25f, 0.5f, 1}, -1}, // twice as far from the photon as its radius
        {origin, {0.1f, 0.1f, 0, 1}, 0, 0, 0.01f, {0, 0, 0}, 1},   // near: left
        {origin, {0.1f, 0.1f, 0, 1}, 2, 0, 0.01f, {1, 2, 4}, -1},  // near, but by way of a mirror
        {origin, {0.9f, 0, 0, 1}, 0, 1, 0.5f, {0, 0, 0}, 1},       // nearer than the other photon's radius
        {origin, {1, 1, 1, 1}, 0, 1, 0.5f, {8, 8, 8}, -1},
        {origin, {1, 0, 0, 1}, 0, none, 0, {0, 0, 0}, -1},             // no photon
        {origin, {1, 0, 0, -1}, 0, 0, 0.01f, {0, 0, 0}, -1},           // it met no diffuse surface
        {{0.5f, 0, 0, 1}, {0.6f, 0, 0, 1}, 0, 0, 0.01f, {0, 0, 0}, 1}, // distances are from the start
    };
    auto& b = this->b();
    constexpr uint before = 2; // elements of `starts` before those of the rays
    std::vector<glm::vec4> starts(before, glm::vec4(-9)), ends, directions, throughputs, weights, gathered;
    std::vector<uint> nearest;
    std::vector<float> distances2;
    for (const auto& r : rays) {
        starts.push_back(r.start);
        ends.push_back(r.end);
        directions.emplace_back(0, 0, 1, r.surfaces);
        throughputs.emplace_back(0.5f, 0.25f, 1, 0);
        weights.emplace_back(0.5f, 1, 0.125f, 0);
        gathered.emplace_back(10, 20, 30, 0);
        nearest.push_back(r.nearest);
        distances2.push_back(r.distance2);
    }
    const auto up
        = [&](const auto& v) { return b.upload(std::span<const typename std::decay_t<decltype(v)>::value_type>(v)); };
    const std::vector<glm::vec4> irradiances = {{1, 2, 4, 0.04f}, {8, 8, 8, 1}};
    for (const bool leaves_near : {true, false}) {
        auto end = up(ends), weight = up(weights), sum = up(gathered);
        b.template run<kernels::add_gathered>(ends.size(),
            {.share = 0.25f, .first = before, .leaves_near = leaves_near ? 1u : 0u},
            reads(up(starts), up(directions), up(throughputs), up(nearest), up(distances2), up(irradiances)),
            writes(end, weight, sum));
        const auto left = b.download(end), weighted = b.download(weight), light = b.download(sum);
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const auto& r = rays[i];
            const bool is_left = leaves_near && r.left > 0;
            EXPECT_EQ(left[i].w, is_left ? 1.0f : -1.0f) << i;
            if (r.end.w > 0) {
                EXPECT_EQ(glm::vec3(weighted[i]), glm::vec3(0.25f, 0.25f, 0.125f)) << i;
            }
            glm::vec3 found = r.added;
            if (!leaves_near && r.left > 0)
                found = glm::vec3(irradiances[r.nearest]);
            const glm::vec3 added = found * glm::vec3(0.25f, 0.25f, 0.125f) * 0.25f;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(light[i][c], gathered[i][c] + added[c], 1e-5f) << i << ", channel " << c;
        }
    }
}

TYPED_TEST(hard_cases_of_shading, biases_add_up_as_the_light_does)
{
    // If the bias of the irradiance is the irradiance itself, that of the pixel is the pixel.
    auto& b = this->b();
    const auto up = [&](const std::vector<glm::vec4>& v) { return b.upload(std::span<const glm::vec4>(v)); };
    const auto points = up({{0, 0, 0, 1}, {0, 0, 0, 2}, {0, 0, 0, 0}});
    const auto throughputs = up({{0.5f, 0.25f, 1, 0}, {1, 1, 1, 0}, {1, 1, 1, 0}});
    const auto light = up({{4, -2, 1, 0}, {0.5f, 0, 0, 0}, {9, 9, 9, 9}}), none = up(std::vector<glm::vec4>(3));
    const auto moments = up({{1, 2, -3, 0}, {0, 1, 0, 0}, {9, 9, 9, 9}});
    const auto used = b.upload(std::span<const glm::uvec2>(std::vector<glm::uvec2>(3)));
    auto pixel = up(std::vector<glm::vec4>(3)), searches = up(std::vector<glm::vec4>(3)),
         bias = up({{}, {1, 1, 1, 0}, {}}), tilt = up(std::vector<glm::vec4>(3)), jump = up(std::vector<glm::vec4>(3));
    for (int ray = 0; ray < 2; ++ray) {
        b.template run<kernels::shade>(
            3, {.share = 0.25f}, reads(points, throughputs, none, none, light, used), writes(pixel, searches));
        b.template run<kernels::shade_bias>(
            3, {.share = 0.25f}, reads(points, throughputs, light, moments, light), writes(bias, tilt, jump));
    }
    const auto pixels = b.download(pixel), biases = b.download(bias), tilts = b.download(tilt),
               jumps = b.download(jump);
    for (std::size_t i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(biases[i][c] - (i == 1 ? 1.0f : 0.0f), pixels[i][c], 1e-6f) << i << ", channel " << c;
    const float mean = 0.5f / std::numbers::pi_v<float> * 1.75f / 3; // of two rays, and of the throughputs
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(tilts[0][c], mean * glm::vec4(1, 2, -3, 0)[c], 1e-6f);
        EXPECT_NEAR(jumps[0][c], mean * glm::vec4(4, -2, 1, 0)[c], 1e-6f);
        EXPECT_EQ(tilts[2][c], 0);
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
