// Photons at diffuse surfaces under a clear coat, compared with integrals in double.
#pragma once

#include "known_coats.hpp"
#include "rough_tests.hpp"

namespace photongrid::testing {
namespace {

    struct coat_case {
        double index, roughness, cosine;
    };

    /// Of photons that meet the surface in one direction, as many pass the coat as it does not reflect; the base takes
    /// its share of each channel; and what leaves is spread as the coat lets it.
    TEST(coats, photons_pass_and_leave_as_coats_and_bases_let_them)
    {
        const dvec3 outward = glm::normalize(dvec3(0.3, 0.8, -0.5)), base(0.9, 0.6, 0.3);
        for (const auto& [index, roughness, cosine] : {coat_case{1.5, 0, 0.9}, {1.5, 0, 0.15}, {1.5, 0.6, 0.9},
                 {1.5, 0.3, 0.2}, {1.5, 1, 0.2}, {6, 0, 0.7}, {3, 0.5, 0.5}, {1, 0.5, 0.3}}) {
            SCOPED_TRACE("index " + std::to_string(index) + ", roughness " + std::to_string(roughness) + ", cosine "
                + std::to_string(cosine));
            constexpr uint n = 1 << 17;
            const dvec3 d = -turned_off(outward, std::acos(cosine), 1);
            const auto [positions, directions, powers]
                = beam(ball_of({"plastic", material_kind::plastic, base, index, roughness}, {}), outward, d, n);
            const known_coat coat{index, roughness * roughness};
            const dvec3 left = coat.left(base);
            const double mean_passed = coat.mean_passed();
            double passed = 0, leaving = 0;
            constexpr std::size_t bins = 20;
            std::vector<double> counts(bins);
            for (std::size_t path = 0; path < n; ++path) {
                const auto event = positions[n + path];
                const bool goes_on = kernels::event_end(event) == kernels::GOES_ON;
                if (kernels::event_kind(event) == kernels::SPECULAR_SURFACE) {
                    ASSERT_TRUE(goes_on) << "coats absorb nothing";
                    continue;
                }
                ++passed;
                ASSERT_TRUE(close(dvec3(glm::vec3(powers[n + path])), dvec3(1), 1e-5)) << "photons keep their power";
                if (!goes_on)
                    continue;
                ++leaving;
                ASSERT_TRUE(close(dvec3(glm::vec3(powers[2 * n + path])), left / left.x, 1e-3));
                const double c = glm::dot(dvec3(glm::vec3(directions[2 * n + path])), outward);
                ASSERT_GT(c, 0);
                ++counts[std::min(static_cast<std::size_t>(c * c * bins), bins - 1)];
            }
            const auto expect_share = [](double found, double of, double share) {
                EXPECT_NEAR(found / of, share, far_off * std::sqrt(share * (1 - share) / of) + 1e-4);
            };
            expect_share(passed, n, 1 - coat.reflected(cosine));
            expect_share(leaving, passed, left.x);
            std::vector<double> shares(bins);
            for (std::size_t bin = 0; bin < bins; ++bin)
                for (int i = 0; i < 10; ++i) // cosine squared is even without a coat
                    shares[bin] += (1 - coat.reflected(std::sqrt((double(bin) + (i + 0.5) / 10) / bins)))
                        / (10 * bins * mean_passed);
            EXPECT_LE(std::abs(deviate(counts, shares, shares, leaving)), far_off);
        }
    }

} // namespace
} // namespace photongrid::testing
