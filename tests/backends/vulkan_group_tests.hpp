// Subgroups: elements that run together on Vulkan.
#pragma once

#include "vulkan_under_test.hpp"

namespace photongrid::testing {

/// What group_probe must have found in each element's group: over_all holds the smallest and the largest number, the
/// sum up to the element and whether any is a multiple of 5; of_lanes the width of the group, the element's lane, the
/// middle lane's number and a weighed sum. `width` is set to the width.
inline void expect_groups(const std::vector<uint>& numbers, const std::vector<uvec4>& over_all,
    const std::vector<uvec4>& of_lanes, uint& width)
{
    const auto n = static_cast<uint>(numbers.size());
    width = of_lanes[0].x;
    ASSERT_TRUE(width >= 1 && width <= 64 && 64 % width == 0) << width;
    for (uint i = 0; i < n; ++i) {
        const uint first = i - i % width, past = std::min(first + width, n);
        uint low = ~0u, high = 0, up_to = 0, weighed = 0;
        bool any = false;
        for (uint j = first; j < past; ++j) {
            low = std::min(low, numbers[j]);
            high = std::max(high, numbers[j]);
            up_to += j <= i ? numbers[j] : 0;
            weighed += numbers[j] * (j - first + 1);
            any = any || numbers[j] % 5 == 0;
        }
        ASSERT_EQ(over_all[i], uvec4(low, high, up_to, any ? 1 : 0)) << i << " of " << n << ", groups of " << width;
        ASSERT_EQ(of_lanes[i].y, i - first);
        if (past - first == width) {
            ASSERT_EQ(of_lanes[i].z, numbers[first + width / 2]);
            ASSERT_EQ(of_lanes[i].w, weighed);
        }
    }
}

/// Neighbours of a subgroup exchange correct values, in all of `run` and `run_until_done`, of any number of elements,
/// done or not; and a group is one element where the switch is off or subgroups are.
TEST_F(vulkan, elements_of_a_group_exchange_values)
{
    uint most_lanes = 1;
    for (const bool staging : {false, true})
        for (const bool subgroups : {true, false})
            for (const uint switches : {0u, 8u})
                for (const uint n : {1u, 7u, 64u, 1003u}) {
                    vulkan_options o;
                    o.validation = true;
                    o.staging = staging;
                    o.subgroups = subgroups;
                    vulkan_backend device(o);
                    device.add_texts(test_kernels::texts);
                    random_source u(n);
                    std::vector<uint> numbers(n);
                    std::vector<uvec2> states(n);
                    for (uint i = 0; i < n; ++i) {
                        numbers[i] = u.below(1000000);
                        states[i] = {1 + u.below(11), 0};
                    }
                    const auto input = up(device, numbers);
                    auto state = up(device, states);
                    auto over_all = device.make<uvec4>(n), of_lanes = device.make<uvec4>(n);
                    const auto check = [&] {
                        uint width = 1;
                        expect_groups(numbers, device.download(over_all), device.download(of_lanes), width);
                        EXPECT_TRUE(width == 1 || (switches != 0 && subgroups)) << width;
                        most_lanes = std::max(most_lanes, width);
                    };
                    device.run<test_kernels::group_probe>(
                        {n, 0u, switches}, {}, reads(input), writes(state, over_all, of_lanes));
                    check();
                    state = up(device, states);
                    const auto p = device.run_until_done<test_kernels::group_probe>(
                        {n, 0u, switches}, {}, reads(input), writes(state, over_all, of_lanes), all_passes);
                    const auto ends = device.download(state);
                    uint longest = 0;
                    for (uint i = 0; i < n; ++i) {
                        ASSERT_EQ(ends[i], uvec2(0, states[i].x)) << i;
                        longest = std::max(longest, states[i].x);
                    }
                    EXPECT_EQ(p.passes, longest);
                    ASSERT_EQ(p.active.size(), longest);
                    for (uint q = 0; q < longest; ++q)
                        EXPECT_EQ(p.active[q],
                            static_cast<std::uint64_t>(
                                std::count_if(states.begin(), states.end(), [&](uvec2 s) { return s.x > q; })));
                    check();
                    EXPECT_EQ(device.validation_messages(), std::vector<std::string>{});
                }
    RecordProperty("lanes", static_cast<int>(most_lanes));
    std::printf("groups of up to %u elements\n", most_lanes);
}

/// Points that search together find what each finds alone, bit for bit: close to each other, far apart, or at one
/// place.
TEST_F(vulkan, points_that_search_together_find_what_each_finds_alone)
{
    vulkan_options apart;
    apart.subgroups = false;
    vulkan_options loops;
    loops.staging = true;
    vulkan_backend alone(apart), looping(loops);
    std::size_t number = 0;
    for (const auto d : all_distributions) {
        constexpr float steps[] = {0.003f, 0.05f, 1e-5f, 2.0f};
        const float step = steps[number++ % 4];
        const auto s = make_photons(d, 3000, uvec3(9, 7, 5), 5);
        random_source u(7);
        std::vector<vec4> points;
        for (const auto& p : make_points(s, 16, 3))
            for (int i = 0; i < 25; ++i) // runs of neighbours that begin anywhere in a group; some unwanted
                points.emplace_back(p.x + step * u(), p.y + step * u(), p.z + step * u(), i % 9 == 4 ? 0.0f : 1.0f);
        // Many of many, so that guesses fail for some of a group and not for others; few, to the radius; in small
        // passes.
        for (auto k : {knn_settings{.k = 50, .max_radius = 0.4f},
                 knn_settings{.k = 50, .max_radius = 0.4f, .search = search_kind::fixed_radius},
                 knn_settings{.k = 1000, .max_radius = 50}})
            for (const uint visits : {3072u, 50u}) {
                k.errors = true;
                k.visits_per_pass = k.k < 1000 ? visits : 20 * visits / 3;
                const auto run = [&](vulkan_backend& device) {
                    const auto map = sorted_map(device, upload_photons(device, s), s.g);
                    const auto e = knn_grid_estimate(device, map, device.upload(std::span<const vec4>(points)), k);
                    return std::tuple(
                        device.download(e.irradiance), device.download(e.standard_error), device.download(e.used));
                };
                const auto [light, error, used] = run(alone);
                for (auto* device : {&b(), &looping}) {
                    const auto [light_too, error_too, used_too] = run(*device);
                    EXPECT_EQ(count_different_bits(light, light_too), 0u);
                    EXPECT_EQ(count_different_bits(error, error_too), 0u);
                    std::size_t differ = 0;
                    for (std::size_t i = 0; i < used.size(); ++i)
                        differ += used[i].x != used_too[i].x ? 1u : 0u;
                    EXPECT_EQ(differ, 0u);
                    if (device == &looping)
                        continue;
                    EXPECT_EQ(count_different_bits(used_too, std::get<2>(run(*device))),
                        0u); // also what they visited, run to run
                }
            }
    }
}

} // namespace photongrid::testing
