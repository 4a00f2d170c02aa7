// Bins on surfaces.
#pragma once

#include "reference_under_test.hpp"

namespace photongrid {
namespace {

    // --- bins ---
    template <class Bins>
    double whole_area(const Bins& b)
    {
        double sum = 0;
        for (std::uint32_t i = 0; i < b.size(); ++i)
            sum += b.area(i);
        return sum;
    }

    template <class Round>
    reference::ring_bins rings(const Round& x, double size)
    {
        return reference::ring_bins(reference::profile_of(x), size);
    }

    TEST(reference, bins_cover_surfaces_exactly)
    {
        using reference::plane_bins;
        const dvec3 from(0.1, 0.2, 0.3), to(0.5, -0.4, 1.2);
        const double h = glm::length(to - from), r = 0.7;
        for (const double size : {3.0, 0.2, 0.013}) {
            EXPECT_NEAR(whole_area(rings(sphere{from, r, 0}, size)), 4 * M_PI * r * r, 1e-11);
            EXPECT_NEAR(whole_area(rings(disk{from, to, r, 0}, size)), M_PI * r * r, 1e-11);
            EXPECT_NEAR(whole_area(rings(cylinder{from, to, r, 0}, size)), 2 * M_PI * r * h, 1e-11);
            EXPECT_NEAR(whole_area(rings(cone{from, to, r, 0}, size)), M_PI * r * std::hypot(r, h), 1e-11);
            EXPECT_NEAR(whole_area(rings(paraboloid{from, to, r, 0}, size)),
                M_PI * r / (6 * h * h) * (std::pow(r * r + 4 * h * h, 1.5) - r * r * r), 1e-11);
            for (std::size_t corners = 3; corners < 9; ++corners) {
                polygon p;
                for (std::size_t i = 0; i < corners; ++i) {
                    const double phi = 2 * M_PI * (static_cast<double>(i) + 0.3 * std::sin(static_cast<double>(i)))
                        / static_cast<double>(corners);
                    p.vertices.push_back(
                        from + std::cos(phi) * dvec3(1, 0.2, 0) + std::sin(phi) * dvec3(0.1, -0.3, 1.4));
                }
                EXPECT_NEAR(whole_area(plane_bins(p, size)), glm::length(area_vector(p)), 1e-11);
            }
        }
        EXPECT_NEAR(whole_area(rings(paraboloid{from, from + dvec3(0, 1e-9, 0), r, 0}, 0.1)), M_PI * r * r,
            1e-11); // nearly flat
    }

    TEST(reference, points_spread_evenly_fill_bins_by_area)
    {
        // Each bin's share of evenly spread points is its share of the area: chi-squared, with points made shape by
        // shape.
        std::mt19937 random(5);
        std::uniform_real_distribution<double> unit;
        const auto expect_even = [&](const char* name, const auto& bins, auto point) {
            const int n = 200000;
            std::vector<int> counts(bins.size(), 0);
            for (int i = 0; i < n; ++i)
                ++counts[bins.at(point())];
            const double total = whole_area(bins);
            double chi2 = 0, degrees = -1;
            for (std::uint32_t b = 0; b < bins.size(); ++b) {
                const double expected = n * bins.area(b) / total;
                if (expected == 0) {
                    EXPECT_EQ(counts[b], 0) << name;
                    continue;
                }
                chi2 += (counts[b] - expected) * (counts[b] - expected) / expected;
                ++degrees;
            }
            EXPECT_GT(degrees, 20) << name;
            EXPECT_LT(std::abs(chi2 - degrees), 5 * std::sqrt(2 * degrees)) << name;
        };
        const auto round_z = [&](double radius, double z) {
            const double phi = 2 * M_PI * unit(random);
            return dvec3(radius * std::cos(phi), radius * std::sin(phi), z);
        };
        expect_even("sphere", rings(sphere{{0, 0, 0}, 1, 0}, 0.2), [&] {
            const double z = 2 * unit(random) - 1;
            return round_z(std::sqrt(1 - z * z), z);
        });
        expect_even(
            "disk", rings(disk{{0, 0, 0}, {0, 0, 1}, 1, 0}, 0.1), [&] { return round_z(std::sqrt(unit(random)), 0); });
        expect_even(
            "cylinder", rings(cylinder{{0, 0, 0}, {0, 0, 2}, 1, 0}, 0.2), [&] { return round_z(1, 2 * unit(random)); });
        expect_even("cone", rings(cone{{0, 0, 0}, {0, 0, 2}, 1, 0}, 0.1), [&] {
            const double x = std::sqrt(unit(random));
            return round_z(x, 2 * (1 - x));
        });
        expect_even("paraboloid", rings(paraboloid{{0, 0, 0}, {0, 0, 2}, 1, 0}, 0.1), [&] {
            for (;;) { // rejection by the area element rho sqrt(1 + 16 rho^2)
                const double rho = unit(random);
                if (unit(random) * std::sqrt(17.0) < rho * std::sqrt(1 + 16 * rho * rho))
                    return round_z(rho, 2 * rho * rho);
            }
        });
        const polygon triangle{{{0, 0, 0}, {1, 0.1, 0.4}, {0.2, 0.9, 0.1}}, 0};
        expect_even("triangle", reference::plane_bins(triangle, 0.07), [&] {
            double a = unit(random), b = unit(random);
            if (a + b > 1) {
                a = 1 - a;
                b = 1 - b;
            }
            return a * triangle.vertices[1] + b * triangle.vertices[2];
        });
    }

    TEST(reference, bins_that_are_too_many_are_refused)
    {
        EXPECT_THROW(rings(sphere{{0, 0, 0}, 1, 0}, 1e-9), std::invalid_argument);
        EXPECT_THROW(rings(paraboloid{{0, 0, 0}, {0, 0, 1e6}, 1, 0}, 1e-3), std::invalid_argument);
        EXPECT_THROW(
            reference::plane_bins(rectangle({0, 0, 0}, {1e9, 0, 0}, {0, 1e9, 0}, 0), 1e-3), std::invalid_argument);
    }

} // namespace
} // namespace photongrid
