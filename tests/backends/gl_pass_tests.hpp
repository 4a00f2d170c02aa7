// Passes of the OpenGL backend.
#pragma once

#include "gl_contexts.hpp"
#include "gl_test_kernels.hpp"

namespace photongrid {
namespace {

    TYPED_TEST(gl_backend_test, counts_by_occlusion)
    {
        gl_backend& b = this->gpu();
        for (std::size_t n : {0u, 1u, 2048u, 2049u, 100000u}) {
            const auto numbers = noise<uint>(n, 3);
            const auto on_gpu = b.upload(view(numbers));
            const auto on_cpu = this->cpu.upload(view(numbers));
            EXPECT_EQ(b.template count<test_kernels::is_odd>(n, {}, reads(on_gpu)),
                this->cpu.template count<test_kernels::is_odd>(n, {}, reads(on_cpu)));
            if (n > 5000) {
                const launch part{n - 3000, 1234};
                EXPECT_EQ(b.template count<test_kernels::is_odd>(part, {}, reads(on_gpu)),
                    this->cpu.template count<test_kernels::is_odd>(part, {}, reads(on_cpu)));
            }
        }
    }

    TYPED_TEST(gl_backend_test, writes_frame_after_frame_into_one_buffer)
    {
        // Strides that end rows and that do not: what lies outside a launch keeps its value.
        for (uint stride : {1u, 3u, 100u, 2048u, 5000u}) {
            const uint frames = 9;
            const auto data = noise<glm::uvec2>(stride * frames, stride);
            auto on_gpu = this->gpu().upload(view(data));
            auto on_cpu = this->cpu.upload(view(data));
            for (uint f = 1; f + 1 < frames; ++f) {
                this->gpu().template run<test_kernels::next_frame>(
                    {stride, f * stride}, {.stride = stride}, reads(on_gpu), writes(on_gpu));
                this->cpu.template run<test_kernels::next_frame>(
                    {stride, f * stride}, {.stride = stride}, reads(on_cpu), writes(on_cpu));
            }
            EXPECT_TRUE(same_bits(this->gpu().download(on_gpu), this->cpu.download(on_cpu))) << "stride " << stride;
        }
    }

    template <class B>
    auto run_eight(B& b, launch l, std::size_t n, std::initializer_list<uint> max_passes, std::vector<progress>& steps)
    {
        std::vector<uint> left(n);
        for (std::size_t i = 0; i < n; ++i)
            left[i] = static_cast<uint>(i % 37 * (i / 5000 % 2));
        const auto ints = [&](uint seed) { return std::vector<float>(n, static_cast<float>(seed)); };
        const auto in0 = b.upload(view(ints(1)));
        const auto in1 = b.upload(view(std::vector<glm::vec2>(n, {0.1f, 0.7f})));
        const auto in2 = b.upload(view(std::vector<glm::vec4>(n, {0.1f, 0.3f, 1e10f, 1e-3f})));
        const auto in3 = b.upload(view(noise<uint>(n, 1)));
        const auto in4 = b.upload(view(noise<glm::uvec2>(n, 2)));
        const auto in5 = b.upload(view(noise<glm::uvec4>(n, 3)));
        const auto in6 = b.upload(view(noise<uint>(n, 4)));
        const auto in7 = b.upload(view(noise<uint>(n, 5)));
        const auto in8 = b.upload(view(noise<uint>(n, 6)));
        const auto in9 = b.upload(view(noise<uint>(n, 7)));
        auto s0 = b.upload(view(ints(0)));
        auto s1 = b.upload(view(std::vector<glm::vec2>(n)));
        auto s2 = b.upload(view(std::vector<glm::vec4>(n)));
        auto s3 = b.upload(view(noise<uint>(n, 11)));
        auto s4 = b.upload(view(noise<glm::uvec2>(n, 12)));
        auto s5 = b.upload(view(noise<glm::uvec4>(n, 13)));
        auto s6 = b.upload(view(noise<uint>(n, 14)));
        auto s7 = b.upload(view(left));
        for (uint most : max_passes)
            steps.push_back(b.template run_until_done<test_kernels::eight>(l, {.add = 5u},
                reads(in0, in1, in2, in3, in4, in5, in6, in7, in8, in9), writes(s0, s1, s2, s3, s4, s5, s6, s7), most));
        return std::tuple(b.download(s0), b.download(s1), b.download(s2), b.download(s3), b.download(s4),
            b.download(s5), b.download(s6), b.download(s7));
    }

    TYPED_TEST(gl_backend_test, runs_only_unfinished_elements)
    {
        for (std::size_t n : {1u, 50u, 2048u, 30000u})
            for (std::initializer_list<uint> passes : {std::initializer_list<uint>{~0u},
                     {1u, 1u, 0u, 3u, 8u, 1u, ~0u, ~0u}, {0u}, {7u}, {8u}, {9u}, {36u}, {37u}})
                for (uint switches : {0u, ~0u}) {
                    const launch l = n == 30000 ? launch{n - 5000, 777, switches} : launch{n, 0, switches};
                    std::vector<progress> gpu_steps, cpu_steps;
                    const auto polls = this->gpu().query_polls();
                    const auto a = run_eight(this->gpu(), l, n, passes, gpu_steps);
                    const auto used_polls = this->gpu().query_polls() - polls;
                    const auto c = run_eight(this->cpu, l, n, passes, cpu_steps);
                    EXPECT_TRUE(same_bits(std::get<0>(a), std::get<0>(c)));
                    EXPECT_TRUE(same_bits(std::get<1>(a), std::get<1>(c)));
                    EXPECT_TRUE(same_bits(std::get<2>(a), std::get<2>(c)));
                    EXPECT_TRUE(same_bits(std::get<3>(a), std::get<3>(c)));
                    EXPECT_TRUE(same_bits(std::get<4>(a), std::get<4>(c)));
                    EXPECT_TRUE(same_bits(std::get<5>(a), std::get<5>(c)));
                    EXPECT_TRUE(same_bits(std::get<6>(a), std::get<6>(c)));
                    EXPECT_TRUE(same_bits(std::get<7>(a), std::get<7>(c)));
                    std::size_t most_polls = 0;
                    for (std::size_t s = 0; s < gpu_steps.size(); ++s) {
                        EXPECT_EQ(gpu_steps[s].passes, cpu_steps[s].passes);
                        EXPECT_EQ(gpu_steps[s].finished, cpu_steps[s].finished) << "n " << n << ", call " << s;
                        EXPECT_EQ(gpu_steps[s].active, cpu_steps[s].active);
                        most_polls += gpu_steps[s].passes / 8 + 1;
                    }
                    EXPECT_LE(used_polls, most_polls);
                }
    }

} // namespace
} // namespace photongrid
