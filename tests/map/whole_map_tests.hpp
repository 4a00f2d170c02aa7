// Maps and searches equal the serial backend's; grids that fit.
#pragma once

#include "algorithms.hpp"

namespace photongrid::testing {

TYPED_TEST_P(algorithms, everything_equals_the_serial_backend_bit_for_bit)
{
    auto& b = this->b();
    serial_backend serial;
    for (const auto d : all_distributions)
        for (const auto resolution : {uvec3(1, 1, 1), uvec3(40, 1, 40), uvec3(9, 9, 18)})
            for (const uint m : {0u, 2u, 16u}) {
                const auto set = make_photons(d, 5000, resolution, 11);
                const auto points = make_points(set, 700, 11);
                const auto run = [&](auto& device) {
                    const auto map = m == 0 ? sorted_map(device, upload_photons(device, set), set.g)
                                            : routed_map(device, upload_photons(device, set), set.g, {m, 6});
                    const auto e = knn_grid_estimate(device, map, device.upload(std::span<const vec4>(points)),
                        as_paper(knn_settings{.k = 64, .max_radius = 0.25f}));
                    return std::tuple{device.download(map.cells), device.download(map.list),
                        device.download(map.photons.powers), device.download(e.irradiance), device.download(e.used)};
                };
                const auto [cells, list, powers, irradiance, used] = run(b);
                const auto [cells_s, list_s, powers_s, irradiance_s, used_s] = run(serial);
                const std::string where = std::string(name_of(d)) + " m " + std::to_string(m);
                EXPECT_EQ(count_different_bits(cells, cells_s), 0u) << where;
                EXPECT_EQ(count_different_bits(list, list_s), 0u) << where;
                EXPECT_EQ(count_different_bits(used, used_s), 0u) << where;
                std::size_t radii = 0;
                for (std::size_t i = 0; i < irradiance.size(); ++i)
                    radii += irradiance[i].w != irradiance_s[i].w ? 1u : 0u;
                EXPECT_EQ(radii, 0u) << where;
                // Light: the redistributed powers and the estimate divide, so only where that rounds correctly are they
                // equal.
                if (b.caps().exact_division) {
                    EXPECT_EQ(count_different_bits(powers, powers_s), 0u) << where;
                }
                if (b.caps().exact_division && adds_as_serial<TypeParam>()) {
                    EXPECT_EQ(count_different_bits(irradiance, irradiance_s), 0u) << where;
                }
                // n terms added in turn: each addition rounds by 2^-24 of a sum that is at most the last one.
                for (std::size_t i = 0; i < irradiance.size(); ++i)
                    for (int c = 0; c < 3; ++c)
                        ASSERT_NEAR(irradiance[i][c], irradiance_s[i][c],
                            static_cast<float>(used[i].x + 8) * 0x1p-24f * irradiance_s[i][c])
                            << where;
            }
}

TYPED_TEST_P(algorithms, a_fitting_grid_suits_any_photons)
{
    auto& b = this->b();
    serial_backend serial;
    for (const auto d : all_distributions)
        for (const std::size_t n : {0u, 1u, 2u, 100u, 20000u}) {
            auto set = make_photons(d, n, {4, 4, 4}, 5);
            if (n == 20000u) { // some stray, some poisoned
                for (std::size_t i = 0; i < 10; ++i)
                    set.positions[i * 1999] = vec4(1e6f, -1e6f, 1e5f * static_cast<float>(i), 0.0f);
                set.positions[7].x = std::numeric_limits<float>::quiet_NaN();
                set.positions[8].y = std::numeric_limits<float>::infinity();
            }
            const auto where = std::string(name_of(d)) + ", " + std::to_string(n) + " photons";
            const auto p = upload_photons(b, set);
            const grid g = fitting_grid(b, p, 50);
            const grid same = fitting_grid(serial, upload_photons(serial, set), 50);
            ASSERT_TRUE(g.origin == same.origin && g.cell == same.cell && g.inverse_cell == same.inverse_cell
                && g.resolution == same.resolution)
                << where;
            ASSERT_LE(cell_count(g), std::max<double>(1.25 * static_cast<double>(n), 64)) << where;
            if (n == 20000u && d != distribution::coincident) {
                ASSERT_GT(cell_count(g), 50u) << where; // strays have not made one cell of all
            }

            // The search is exact in any grid.
            const auto points = make_points(set, 40, 5);
            const auto map = sorted_map(b, upload_photons(b, set), g);
            const auto e = b.download(
                knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)), {.k = 50, .max_radius = 1})
                    .irradiance);
            for (std::size_t q = 0; q < points.size(); ++q) {
                std::vector<float> distances;
                for (const auto& photon : set.positions)
                    if (const float d2 = distance2(photon, points[q]); d2 <= 1)
                        distances.push_back(d2);
                std::sort(distances.begin(), distances.end());
                if (std::isfinite(points[q].x) && std::isfinite(points[q].y)) {
                    ASSERT_EQ(e[q].w, distances.size() >= 50 ? distances[49] : 1.0f) << where << ", point " << q;
                }
            }
        }

    // Cells are about as wide as the k-th distance, half as wide along x: photons on a plane have a known one.
    const auto plane = make_photons(distribution::planar, 50000, {4, 4, 4}, 6);
    const grid g = fitting_grid(b, upload_photons(b, plane), 50);
    const double kth = std::sqrt(50 / (M_PI * 50000));
    EXPECT_EQ(g.resolution.y, 1u);
    EXPECT_NEAR(g.cell.z, kth, 0.25 * kth);
    EXPECT_NEAR(g.cell.x, 0.5 * kth, 0.125 * kth);
}

} // namespace photongrid::testing
