// Buffers, limits and arithmetic of any backend.
#pragma once

#include "algorithms.hpp"

namespace photongrid::testing {

TYPED_TEST_P(algorithms, buffers_keep_every_bit)
{
    auto& b = this->b();
    for (const std::size_t n : {0u, 1u, 2u, 63u, 64u, 2047u, 2048u, 2049u, 70000u}) {
        random_source u(n);
        const auto check = [&](auto make) {
            std::vector<decltype(make())> host(n);
            for (auto& x : host)
                x = make();
            const auto device = b.upload(std::span<const decltype(make())>(host));
            ASSERT_EQ(device.size(), n);
            EXPECT_EQ(count_different_bits(b.download(device), host), 0u);
        };
        const auto integer = [&] { return u.below(0xFFFFFFFFu); };
        check([&] { return integer(); });
        check([&] { return uvec2(integer(), integer()); });
        check([&] { return glm::uvec4(integer(), integer(), integer(), integer()); });
        check([&] { return u() * 1e6f; });
        check([&] { return glm::vec2(u(), -u()); });
        check([&] { return vec4(u(), -u(), u() * 1e30f, u() * 1e-30f); });
    }
}

TYPED_TEST_P(algorithms, a_pass_outside_a_buffer_is_refused)
{
    auto& b = this->b();
    auto in = b.template make<uint>(10);
    auto small = b.template make<uint>(9);
    auto pairs = b.template make<uvec2>(10);
    EXPECT_THROW(b.template run<kernels::pair_value>(10, {}, reads(pairs), writes(small)), std::invalid_argument);
    EXPECT_THROW(b.template run<kernels::pair_value>({10, 1}, {}, reads(pairs), writes(in)), std::invalid_argument);
    EXPECT_NO_THROW(b.template run<kernels::pair_value>({9, 1}, {}, reads(pairs), writes(in)));
}

TYPED_TEST_P(algorithms, memory_is_accounted_for)
{
    auto& b = this->b();
    const auto before = b.bytes();
    {
        const auto buffer = b.template make<vec4>(100000);
        EXPECT_GE(b.bytes(), before + 1600000u);
        EXPECT_GE(b.peak_bytes(), b.bytes());
    }
    b.finish();
    EXPECT_EQ(b.bytes(), before);
}

TYPED_TEST_P(algorithms, the_self_test_of_arithmetic_agrees_with_the_capabilities)
{
    const auto [division, square_root] = test_arithmetic(this->b());
    EXPECT_EQ(division, this->b().caps().exact_division);
    EXPECT_EQ(square_root, this->b().caps().exact_sqrt);
}

TYPED_TEST_P(algorithms, no_photon_lies_beyond_the_last_of_more_cells_than_floats_count)
{
    auto& b = this->b();
    const uint cells = (1u << 24) + 4;
    const std::vector<vec4> positions{{0, 0, 0, 0}, {1, 0, 0, 0}, {1e30f, 0, 0, 0}, {0.5f, 0, 0, 0}},
        powers(4, vec4(1));
    auto pairs = b.template make<uvec2>(4);
    b.template run<kernels::photon_cell>(4,
        {.grid = make_grid(glm::vec3(0), glm::vec3(1), {cells, 1, 1}), .photons = 4, .parts = every_part},
        reads(b.upload(std::span<const vec4>(positions)), b.upload(std::span<const vec4>(powers))), writes(pairs));
    EXPECT_EQ(b.download(pairs), (std::vector<uvec2>{{0, 0}, {cells - 1, 1}, {cells - 1, 2}, {cells / 2, 3}}));
}

// --- bitonic_sort
// -----------------------------------------------------------------------------------------------------

} // namespace photongrid::testing
