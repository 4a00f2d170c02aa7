// Passes of the Vulkan backend.
#pragma once

#include "vulkan_under_test.hpp"

namespace photongrid::testing {

TEST_F(vulkan, frames_of_one_buffer_are_read_and_written_in_one_pass)
{
    const uint n = 1000, frames = 5;
    const auto run = [&](auto& backend) {
        std::vector<uint> host(n * frames, 7u);
        std::iota(host.begin(), host.begin() + n, 0u);
        auto buffer = up(backend, host);
        for (uint f = 1; f < frames; ++f)
            backend.template run<test_kernels::next_frame>({n, f * n}, {.frame = n}, reads(buffer), writes(buffer));
        return backend.download(buffer);
    };
    EXPECT_EQ(run(b()), run(serial));
}

TEST_F(vulkan, passes_of_many_workgroups_reach_every_element)
{
    const uint n = 65535u * 64u + 100u; // more groups than one dimension takes
    const auto before = up(b(), std::vector<uint>(n, 3u));
    auto after = b().make<uint>(n);
    b().run<test_kernels::next_frame>(n, {.frame = 0}, reads(before), writes(after));
    EXPECT_EQ(b().download(after), std::vector<uint>(n, 7u));
}

TEST_F(vulkan, eight_inputs_and_eight_outputs)
{
    const auto run = [&](auto& backend) {
        std::vector<uint> host(300);
        std::iota(host.begin(), host.end(), 5u);
        const auto in = up(backend, host);
        std::array<decltype(up(backend, host)), 8> out;
        for (auto& o : out)
            o = up(backend, host);
        for (int pass = 0; pass < 2; ++pass)
            backend.template run<test_kernels::eight_states>(host.size(), {}, reads(in, in, in, in, in, in, in, in),
                writes(out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7]));
        std::vector<uint> all;
        for (auto& o : out)
            for (const uint x : backend.download(o))
                all.push_back(x);
        return all;
    };
    EXPECT_EQ(run(b()), run(serial));
}

TEST_F(vulkan, float_arithmetic_is_neither_fused_nor_folded)
{
    const auto host = numbers(100000, 1);
    const auto run = [&](auto& backend) {
        const auto in = up(backend, host);
        auto out = backend.template make<vec4>(host.size());
        backend.template run<test_kernels::contracts>(host.size(), {}, reads(in), writes(out));
        return backend.download(out);
    };
    auto computed = run(b()), expected = run(serial);
    if (!b().caps().exact_division) // w is a quotient and a number
        for (std::size_t i = 0; i < host.size(); ++i) {
            ASSERT_NEAR(computed[i].w, expected[i].w, 4 * 0x1p-24f * (std::abs(host[i].z / 3.3f) + 1)) << i;
            computed[i].w = expected[i].w = 0;
        }
    EXPECT_EQ(count_different_bits(computed, expected), 0u);
}

TEST_F(vulkan, passes_over_unfinished_elements_fall_and_can_be_resumed)
{
    for (const uint n : {0u, 1u, 64u, 65u, 100000u}) {
        std::vector<uvec2> host(n);
        for (uint i = 0; i < n; ++i)
            host[i] = uvec2(i % 21u, 0u);
        const auto expected = [&] {
            auto state = up(serial, host);
            auto p = serial.run_until_done<test_kernels::countdown>(n, {.step = 1}, reads(), writes(state), all_passes);
            return std::pair(serial.download(state), p);
        }();
        auto state = up(b(), host);
        const auto p = b().run_until_done<test_kernels::countdown>(n, {.step = 1}, reads(), writes(state), all_passes);
        EXPECT_EQ(b().download(state), expected.first);
        EXPECT_TRUE(p.finished);
        EXPECT_EQ(p.passes, expected.second.passes);
        EXPECT_EQ(p.active, expected.second.active);
        EXPECT_TRUE(std::is_sorted(p.active.rbegin(), p.active.rend()));

        state = up(b(), host);
        uint passes = 0;
        for (bool finished = n == 0; !finished; ++passes) {
            const auto one = b().run_until_done<test_kernels::countdown>(n, {.step = 1}, reads(), writes(state), 1);
            ASSERT_LE(one.passes, 1u);
            ASSERT_LT(passes, 30u);
            finished = one.finished;
        }
        EXPECT_EQ(b().download(state), expected.first);
        for (const uint most : {0u, 7u, 8u, 9u, 16u, 17u}) {
            state = up(b(), host);
            auto reference = up(serial, host);
            const auto some = b().run_until_done<test_kernels::countdown>(n, {.step = 1}, reads(), writes(state), most);
            const auto same
                = serial.run_until_done<test_kernels::countdown>(n, {.step = 1}, reads(), writes(reference), most);
            EXPECT_EQ(some.passes, same.passes) << most;
            EXPECT_EQ(some.finished, same.finished) << most;
            EXPECT_EQ(some.active, same.active) << most;
            EXPECT_EQ(b().download(state), serial.download(reference)) << most;
        }
    }
}

TEST_F(vulkan, unfinished_elements_of_a_part_of_a_buffer)
{
    const std::vector<uvec2> host(1000, uvec2(12u, 0u));
    const auto run = [&](auto& backend) {
        auto state = up(backend, host);
        backend.template run_until_done<test_kernels::countdown>({333, 400}, {.step = 1}, reads(), writes(state), 10u);
        return backend.download(state);
    };
    EXPECT_EQ(run(b()), run(serial));
}

/// Batches have descriptor sets and timestamps for so many passes: the validation layer reports a pass too many.
TEST_F(vulkan, batches_have_room_for_their_passes)
{
    vulkan_backend timed({.validation = true, .time_passes = true});
    timed.add_texts(test_kernels::texts);
    constexpr uint passes = 3 * photongrid::vulkan::passes_per_batch + 1;
    auto values = up(timed, std::vector<uint>(64, 0u));
    for (uint p = 0; p < passes; ++p)
        timed.run<test_kernels::next_frame>(64, {.frame = 0}, reads(values), writes(values));
    EXPECT_EQ(timed.download(values), std::vector<uint>(64, 0xFFFFFFFFu));
    EXPECT_EQ(timed.costs().at("next_frame").passes, passes);
    EXPECT_EQ(timed.validation_messages(), std::vector<std::string>{});
}

/// A route sorts draws by destination and finds ranges, slots and totals: each dispatch is counted.
TEST_F(vulkan, the_dispatches_of_a_route_are_counted)
{
    const auto passes = [&] { return total_cost(b().costs()).passes; };
    for (const auto& [destinations, digits] : {std::pair{10u, 1u}, {100u, 2u}, {5000u, 4u}}) {
        auto slots = b().make<uint>(destinations * route_capacity(2));
        auto totals = b().make<glm::vec4>(destinations);
        const auto in = up(b(), numbers(100, destinations));
        const auto before = passes();
        b().route<test_kernels::sends>(
            launch(100), {.destinations = destinations}, reads(in), {destinations, 2}, slots, totals);
        // The kernel; keys; counting, scanning and scattering each digit of 4 bits; ranges, slots and totals.
        EXPECT_EQ(passes() - before, 1 + 1 + 3 * digits + 3) << destinations;
    }
}

TEST_F(vulkan, route_equals_serial_bit_for_bit)
{
    for (const std::size_t n : {0u, 1u, 255u, 257u, 5000u, 100000u})
        for (const uint destinations : {1u, 15u, 16u, 1000u})
            for (const uint m : {1u, 4u, 16u}) {
                const auto host = numbers(n, n + destinations);
                const auto run = [&](auto& backend) {
                    const auto in = up(backend, host);
                    // Larger than needed: what nothing is destined for is emptied too. Some draws have no destination.
                    auto slots = up(backend, std::vector<uint>((destinations + 3) * route_capacity(m), 5u));
                    auto totals = up(backend, std::vector<vec4>(destinations + 3, vec4(5)));
                    backend.template route<test_kernels::sends>(launch(n),
                        {.destinations = destinations + destinations / 10}, reads(in), {destinations, m}, slots,
                        totals);
                    return std::pair(backend.download(slots), backend.download(totals));
                };
                const auto [slots, totals] = run(b());
                const auto [expected_slots, expected_totals] = run(serial);
                EXPECT_EQ(slots, expected_slots) << n << " draws, " << destinations << " destinations, m " << m;
                EXPECT_EQ(count_different_bits(totals, expected_totals), 0u)
                    << n << " draws, " << destinations << " destinations, m " << m;
            }
}

// --- the algorithms against serial
// ------------------------------------------------------------------------------------

} // namespace photongrid::testing
