// Buffers of the Vulkan backend.
#pragma once

#include "vulkan_under_test.hpp"

namespace photongrid::testing {

// --- buffers
// ----------------------------------------------------------------------------------------------------------

template <backend B>
void expect_round_trips(B& b)
{
    for (const std::size_t n : {0u, 1u, 63u, 64u, 65u, 100000u}) {
        random_source u(n);
        const auto check = [&](auto make) {
            std::vector<decltype(make())> host(n);
            for (auto& x : host)
                x = make();
            const auto device = up(b, host);
            ASSERT_EQ(device.size(), n);
            EXPECT_EQ(count_different_bits(b.download(device), host), 0u);
        };
        const auto integer = [&] { return u.below(0xFFFFFFFFu); };
        check([&] { return integer(); });
        check([&] { return uvec2(integer(), integer()); });
        check([&] { return uvec4(integer(), integer(), integer(), integer()); });
        check([&] { return u() - 0.5f; });
        check([&] { return glm::vec2(u(), -u()); });
        check([&] { return vec4(u(), u(), u() * 1e30f, u() * 1e-30f); });
    }
}

TEST_F(vulkan, buffers_keep_every_bit) { expect_round_trips(b()); }

TEST_F(vulkan, buffers_move_and_may_outlive_their_backend)
{
    vulkan_backend::buffer<uint> kept;
    EXPECT_EQ(kept.size(), 0u);
    {
        vulkan_backend other;
        kept = other.make<uint>(1000);
        auto gone = other.make<uint>(1000);
        gone = std::move(kept);
        EXPECT_EQ(kept.size(), 0u); // NOLINT(bugprone-use-after-move)
        kept = std::move(gone);
    }
    EXPECT_EQ(kept.size(), 1000u);
}

TEST_F(vulkan, a_buffer_may_be_destroyed_before_recorded_passes_that_use_it)
{
    const std::vector<uint> host(5000, 1u);
    auto last = up(b(), host);
    for (int pass = 0; pass < 200; ++pass) {
        auto next = b().make<uint>(host.size());
        b().run<test_kernels::next_frame>(host.size(), {.frame = 0}, reads(last), writes(next));
        last = std::move(next);
    }
    const auto result = b().download(last);
    EXPECT_EQ(result, std::vector<uint>(host.size(), 0xFFFFFFFFu)); // 2^201 - 1 modulo 2^32
}

TEST_F(vulkan, a_buffer_beyond_the_limit_is_refused_with_the_numbers)
{
    const auto n = b().caps().max_elements + 1;
    try {
        (void)b().make<vec4>(n);
        FAIL() << "a buffer of " << n << " elements was made";
    } catch (const backend_error& e) {
        EXPECT_NE(std::string(e.what()).find(std::to_string(n)), std::string::npos) << e.what();
        EXPECT_NE(std::string(e.what()).find(std::to_string(n - 1)), std::string::npos) << e.what();
    }
}

// --- passes
// -----------------------------------------------------------------------------------------------------------

} // namespace photongrid::testing
