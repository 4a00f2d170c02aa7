// Structural similarity against its definition, window by window.
#pragma once

#include "image_under_test.hpp"

#include <photongrid/compare/structural_similarity.hpp>
#include <photongrid/io/tone_map.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace photongrid {
namespace {

    image noise(std::uint32_t width, std::uint32_t height, float strength, unsigned seed)
    {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> u(-1, 1);
        image picture{width, height, {}};
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) {
                const float smooth = 0.3f + 0.2f * std::sin(0.2f * static_cast<float>(x + 2 * y));
                picture.pixels.emplace_back(
                    smooth + strength * u(random), smooth + strength * u(random), 0.5f * smooth + strength * u(random));
            }
        return picture;
    }

    /// The definition: means, variances and covariance under a window of two dimensions, about each pixel in turn.
    double similarity_by_definition(const image& a, const image& b, double exposure)
    {
        const auto luma = [&](const image& p, int x, int y) {
            const auto& v = p.pixels[static_cast<std::size_t>(y) * p.width + static_cast<std::size_t>(x)];
            return 0.299 * tone_mapped(v.x, exposure) + 0.587 * tone_mapped(v.y, exposure)
                + 0.114 * tone_mapped(v.z, exposure);
        };
        const int width = static_cast<int>(a.width), height = static_cast<int>(a.height);
        double sum = 0;
        for (int cy = 0; cy < height; ++cy)
            for (int cx = 0; cx < width; ++cx) {
                const auto each = [&](const auto& f) {
                    for (int y = std::max(cy - 5, 0); y <= std::min(cy + 5, height - 1); ++y)
                        for (int x = std::max(cx - 5, 0); x <= std::min(cx + 5, width - 1); ++x)
                            f(std::exp(-((x - cx) * (x - cx) + (y - cy) * (y - cy)) / 4.5), luma(a, x, y),
                                luma(b, x, y));
                };
                double weights = 0, mean_a = 0, mean_b = 0, var_a = 0, var_b = 0, both = 0;
                each([&](double w, double p, double q) {
                    weights += w;
                    mean_a += w * p;
                    mean_b += w * q;
                });
                mean_a /= weights;
                mean_b /= weights;
                each([&](double w, double p, double q) {
                    var_a += w * (p - mean_a) * (p - mean_a) / weights;
                    var_b += w * (q - mean_b) * (q - mean_b) / weights;
                    both += w * (p - mean_a) * (q - mean_b) / weights;
                });
                sum += (2 * mean_a * mean_b + 6.5025) * (2 * both + 58.5225)
                    / ((mean_a * mean_a + mean_b * mean_b + 6.5025) * (var_a + var_b + 58.5225));
            }
        return sum / (width * height);
    }

    TEST(similarity, is_what_its_definition_says)
    {
        for (const auto& [width, height] : {std::pair{1u, 1u}, {3u, 2u}, {11u, 11u}, {40u, 7u}, {23u, 31u}})
            for (const double exposure : {0.0, 1.5, -3.0}) {
                const auto a = noise(width, height, 0.1f, 1), b = noise(width, height, 0.1f, 2);
                EXPECT_NEAR(structural_similarity(a, b, exposure), similarity_by_definition(a, b, exposure), 1e-9)
                    << width << " x " << height << " at " << exposure;
            }
    }

    TEST(similarity, is_one_for_the_same_picture_and_falls_with_noise)
    {
        const auto clean = noise(64, 48, 0, 1);
        EXPECT_NEAR(structural_similarity(clean, clean), 1, 1e-12);
        double before = 1;
        for (const float strength : {0.01f, 0.03f, 0.1f, 0.3f}) {
            const double now = structural_similarity(noise(64, 48, strength, 2), clean);
            EXPECT_LT(now, before - 1e-3) << strength;
            before = now;
        }
    }

    TEST(similarity, takes_what_is_not_finite_as_black_and_refuses_other_sizes)
    {
        auto a = noise(16, 16, 0, 1), b = a;
        a.pixels[37] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
        b.pixels[37] = glm::vec3(0);
        EXPECT_NEAR(structural_similarity(a, b), 1, 1e-12);
        EXPECT_THROW((void)structural_similarity(a, noise(16, 15, 0, 1)), std::invalid_argument);
    }

} // namespace
} // namespace photongrid
