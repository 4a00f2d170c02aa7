// Algorithms on the Vulkan backend equal the serial ones.
#pragma once

#include "../core/same_light.hpp"
#include "vulkan_under_test.hpp"

namespace photongrid::testing {

struct everything {
    std::vector<uvec2> cells;
    std::vector<uint> list;
    std::vector<vec4> powers, irradiance;
    std::vector<uvec2> used;
    uint invalid = 0, overflowing = 0;
};

template <backend B>
everything map_and_estimate(
    B& b, const photon_set& s, const std::vector<vec4>& points, uint m, const knn_settings& settings)
{
    auto map = m == 0 ? sorted_map(b, upload_photons(b, s), s.g) : routed_map(b, upload_photons(b, s), s.g, {m, 3u});
    const auto q = up(b, points);
    auto e = knn_grid_estimate(b, map, q, settings);
    return {b.download(map.cells), b.download(map.list), b.download(map.photons.powers), b.download(e.irradiance),
        b.download(e.used), map.invalid, map.overflowing_cells};
}

void expect_equal(const capabilities& device, const everything& a, const everything& b, uint k)
{
    EXPECT_EQ(count_different_bits(a.cells, b.cells), 0u);
    EXPECT_EQ(count_different_bits(a.list, b.list), 0u);
    expect_same_light(device, a.powers, b.powers, 1, "powers");
    expect_same_light(device, a.irradiance, b.irradiance, k, "irradiance");
    EXPECT_EQ(count_different_bits(a.used, b.used), 0u);
    EXPECT_EQ(a.invalid, b.invalid);
    EXPECT_EQ(a.overflowing, b.overflowing);
}

TEST_F(vulkan, sort_equals_serial)
{
    for (const std::size_t n : {0u, 1u, 2u, 3u, 5u, 1000u, 65536u}) {
        random_source u(n);
        std::vector<uvec2> host(n);
        for (auto& x : host)
            x = uvec2(u.below(50), u.below(1000));
        const auto run = [&](auto& backend) {
            auto pairs = up(backend, host);
            bitonic_sort(backend, pairs);
            return backend.download(pairs);
        };
        EXPECT_EQ(run(b()), run(serial)) << n << " pairs";
    }
}

TEST_F(vulkan, maps_and_estimates_equal_serial)
{
    for (const auto d : all_distributions)
        for (const std::size_t n : {0u, 1u, 1000u, 20000u})
            for (const uint m : {0u, 1u, 2u, 4u, 15u, 16u}) {
                SCOPED_TRACE(std::string(name_of(d)) + ", " + std::to_string(n) + " photons, m " + std::to_string(m));
                auto s = make_photons(d, n, uvec3(9, 7, 11), n + m);
                if (n > 10) {
                    s.positions[3].y = std::numeric_limits<float>::quiet_NaN();
                    s.powers[7].x = std::numeric_limits<float>::infinity();
                }
                const auto points = make_points(s, 100, n); // each of 168 maps is compared whole besides
                const knn_settings settings{.k = 50, .max_radius = 0.4f};
                expect_equal(b().caps(), map_and_estimate(b(), s, points, m, settings),
                    map_and_estimate(serial, s, points, m, settings), settings.k);
            }
}

TEST_F(vulkan, a_crowded_cell_is_read_to_its_end)
{
    photon_set s;
    s.g = make_grid(glm::vec3(0), glm::vec3(1), uvec3(3, 3, 3));
    random_source u(5);
    for (uint i = 0; i < 100000; ++i) {
        s.positions.emplace_back(0.5f + 0.01f * u(), 0.5f + 0.01f * u(), 0.5f + 0.01f * u(), 0.0f);
        s.powers.emplace_back(u(), u(), u(), 0.0f);
    }
    const auto points = make_points(s, 100, 1);
    for (const uint m : {0u, 16u})
        expect_equal(b().caps(), map_and_estimate(b(), s, points, m, {.k = 32, .max_radius = 2.0f}),
            map_and_estimate(serial, s, points, m, {.k = 32, .max_radius = 2.0f}), 32);
}

// On a device that rounds correctly nothing needs it; there its fma may round twice.
TEST_F(vulkan, rewritten_quotients_and_roots_are_good)
{
    vulkan_backend rewriting({.arithmetic = arithmetic_kind::rewritten});
    expect_good_arithmetic(rewriting);
}

TEST_F(vulkan, rewritten_arithmetic_gives_the_same_light)
{
    vulkan_backend rewriting({.arithmetic = arithmetic_kind::rewritten});
    const auto s = make_photons(distribution::clustered, 20000, uvec3(9, 7, 11), 4);
    const auto points = make_points(s, 100, 5);
    const knn_settings settings{.k = 50, .max_radius = 0.4f};
    for (const uint m : {0u, 4u})
        expect_equal(rewriting.caps(), map_and_estimate(rewriting, s, points, m, settings),
            map_and_estimate(serial, s, points, m, settings), settings.k);
}

// --- compiling
// --------------------------------------------------------------------------------------------------------

} // namespace photongrid::testing
