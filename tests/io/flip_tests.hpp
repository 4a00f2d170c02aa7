// FLIP against its definition, pixel by pixel, against published colours and against the authors' program.
#pragma once

#include "pictures_with_errors.hpp"

#include <photongrid/compare/flip.hpp>
#include <photongrid/io/tone_map.hpp>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace photongrid {
namespace {

    /// FLIP by the paper's formulas, with filters of two dimensions, in double precision. The primaries and the white
    /// of sRGB give its colours.
    class flip_by_definition {
    public:
        flip_by_definition(double exposure, double per_degree) : exposure_(exposure), per_degree_(per_degree)
        {
            const auto xyz = [](double x, double y) { return glm::dvec3(x / y, 1, (1 - x - y) / y); };
            white_ = xyz(0.3127, 0.3290);
            const glm::dmat3 primaries(xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06));
            const auto scale = glm::inverse(primaries) * white_;
            to_xyz_ = glm::dmat3(primaries[0] * scale.x, primaries[1] * scale.y, primaries[2] * scale.z);
        }

        double at(const image& a, const image& b, int x, int y) const
        {
            const double cmax = std::pow(hyab(hunt({0, 1, 0}), hunt({0, 0, 1})), 0.7), pccmax = 0.4 * cmax;
            const double c = std::pow(hyab(filtered(a, x, y), filtered(b, x, y)), 0.7);
            const double color = c < pccmax ? 0.95 / pccmax * c : 0.95 + (c - pccmax) / (cmax - pccmax) * (1 - 0.95);
            const auto edge = [](double at, double, double) { return -at; };
            const auto point = [](double at, double, double sigma) { return at * at / (sigma * sigma) - 1; };
            const double feature = std::max(std::abs(strength(a, x, y, edge) - strength(b, x, y, edge)),
                std::abs(strength(a, x, y, point) - strength(b, x, y, point)));
            return std::pow(color, 1 - std::sqrt(feature / std::numbers::sqrt2));
        }

    private:
        using derivative = std::function<double(double along, double beside, double sigma)>;

        glm::dvec3 relative(const image& p, int x, int y) const
        {
            x = std::clamp(x, 0, static_cast<int>(p.width) - 1);
            y = std::clamp(y, 0, static_cast<int>(p.height) - 1);
            const auto& v = p.pixels[static_cast<std::size_t>(y) * p.width + static_cast<std::size_t>(x)];
            const auto shown = [&](float linear) { return linear_value(tone_mapped(linear, exposure_)); };
            return to_xyz_ * glm::dvec3(shown(v.x), shown(v.y), shown(v.z)) / white_;
        }
        glm::dvec3 hunt(const glm::dvec3& linear) const
        {
            auto f = to_xyz_ * linear / white_;
            for (int i = 0; i < 3; ++i)
                f[i] = f[i] > 216.0 / 24389 ? std::cbrt(f[i]) : (24389.0 / 27 * f[i] + 16) / 116;
            const double l = 116 * f.y - 16;
            return {l, 0.01 * l * 500 * (f.x - f.y), 0.01 * l * 200 * (f.y - f.z)};
        }
        static double hyab(const glm::dvec3& p, const glm::dvec3& q)
        {
            return std::abs(p.x - q.x) + std::sqrt((p.y - q.y) * (p.y - q.y) + (p.z - q.z) * (p.z - q.z));
        }
        glm::dvec3 filtered(const image& p, int x, int y) const
        {
            constexpr double pi = std::numbers::pi;
            const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * per_degree_));
            glm::dvec3 sum(0), weights(0);
            for (int j = -radius; j <= radius; ++j)
                for (int i = -radius; i <= radius; ++i) {
                    const double squared = (i * i + j * j) / (per_degree_ * per_degree_);
                    const auto g
                        = [&](double a, double b) { return a * std::sqrt(pi / b) * std::exp(-pi * pi * squared / b); };
                    const glm::dvec3 w(g(1, 0.0047), g(1, 0.0053), g(34.1, 0.04) + g(13.5, 0.025));
                    const auto r = relative(p, x + i, y + j);
                    sum += w * glm::dvec3(116 * r.y - 16, 500 * (r.x - r.y), 200 * (r.y - r.z));
                    weights += w;
                }
            const auto c = sum / weights;
            const double luminance = (c.x + 16) / 116;
            const auto xyz = glm::dvec3(c.y / 500 + luminance, luminance, luminance - c.z / 200) * white_;
            return hunt(glm::clamp(glm::inverse(to_xyz_) * xyz, 0.0, 1.0));
        }
        double strength(const image& p, int x, int y, const derivative& d) const
        {
            const double sigma = 0.5 * 0.082 * per_degree_;
            const int radius = static_cast<int>(std::ceil(3 * sigma));
            double sums[2][2] = {}, weights[2] = {};
            for (int j = -radius; j <= radius; ++j)
                for (int i = -radius; i <= radius; ++i) {
                    const double w = d(i, j, sigma) * std::exp(-(i * i + j * j) / (2 * sigma * sigma));
                    const int sign = w > 0 ? 0 : 1;
                    weights[sign] += std::abs(w);
                    sums[0][sign] += w * relative(p, x + i, y + j).y;
                    sums[1][sign] += w * relative(p, x + j, y + i).y;
                }
            return std::hypot(
                sums[0][0] / weights[0] + sums[0][1] / weights[1], sums[1][0] / weights[0] + sums[1][1] / weights[1]);
        }

        double exposure_, per_degree_;
        glm::dvec3 white_;
        glm::dmat3 to_xyz_;
    };

    TEST(flip, is_what_its_definition_says)
    {
        for (const auto& [width, height] : {std::pair{1, 1}, {3, 2}, {17, 9}})
            for (const double per_degree : {1.0, 20.0, 67.0}) {
                const auto a = random_picture(width, height, 1, 1), b = random_picture(width, height, 1, 2);
                const auto found = flip_difference(a, b, 0.5, per_degree);
                const flip_by_definition expected(0.5, per_degree);
                double mean = 0;
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x) {
                        const double value = expected.at(a, b, x, y);
                        mean += value / (width * height);
                        EXPECT_NEAR(found.values[static_cast<std::size_t>(y * width + x)], value, 1e-4)
                            << x << ',' << y << " of " << width << " x " << height << " at " << per_degree;
                    }
                EXPECT_NEAR(found.mean, mean, 1e-4);
            }
    }

    // Computed by the authors' C++ program (FLIP.h of September 2025) from the same pictures.
    TEST(flip, is_what_its_authors_compute)
    {
        const auto encoded = [](int red, int green, int blue) {
            const auto linear = [](int v) { return linear_value(static_cast<unsigned char>((v + 512) % 256)); };
            return glm::vec3(linear(red), linear(green), linear(blue));
        };
        image a{48, 32, {}}, b{48, 32, {}};
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 48; ++x) {
                const int red = (5 * x + 3 * y) % 256, green = x * y % 256, blue = (200 - 2 * x + 4 * y) % 256;
                b.pixels.push_back(encoded(red, green, blue));
                a.pixels.push_back(
                    encoded(red + (x * x + 7 * y) % 40, green, x / 8 % 2 == y / 8 % 2 ? blue : 255 - blue));
            }
        const auto at = [](const flip_map& map, std::size_t x, std::size_t y) { return map.values[y * 48 + x]; };
        const auto fine = flip_difference(a, b);
        EXPECT_NEAR(fine.mean, 0.525545, 2e-5);
        EXPECT_NEAR(at(fine, 0, 0), 0.032396, 1e-4);
        EXPECT_NEAR(at(fine, 20, 10), 0.643869, 1e-4);
        EXPECT_NEAR(at(fine, 47, 31), 0.140861, 1e-4);
        const auto coarse = flip_difference(a, b, 0, 30);
        EXPECT_NEAR(coarse.mean, 0.547852, 2e-5);
        EXPECT_NEAR(at(coarse, 0, 0), 0.005639, 1e-4);
        EXPECT_NEAR(at(coarse, 20, 10), 0.907650, 1e-4);
        EXPECT_NEAR(at(coarse, 47, 31), 0.155947, 1e-4);
    }

    // The corners of sRGB as tables of CIE L*a*b* with D65 have them; near black L* is 903.3 times the luminance.
    TEST(flip, has_the_colours_of_the_cie)
    {
        const auto expect_lab = [](const glm::dvec3& linear, const glm::dvec3& lab) {
            const auto found = detail::cielab(linear);
            for (int i = 0; i < 3; ++i)
                EXPECT_NEAR(found[i], lab[i], 0.05) << i << " of " << lab.x;
        };
        expect_lab({0, 0, 0}, {0, 0, 0});
        expect_lab({1, 1, 1}, {100, 0, 0});
        expect_lab({1, 0, 0}, {53.24, 80.09, 67.20});
        expect_lab({0, 1, 0}, {87.73, -86.18, 83.18});
        expect_lab({0, 0, 1}, {32.30, 79.19, -107.86});
        expect_lab(glm::dvec3(0.001), {0.9033, 0, 0});
    }

    TEST(flip, of_black_and_white_is_that_of_their_lightness)
    {
        const auto evenly = [](float v) { return image{30, 20, std::vector<glm::vec3>(600, glm::vec3(v))}; };
        const auto found = flip_difference(evenly(0), evenly(1));
        // L* differs by 100. Green and blue: (87.73, -75.61, 72.97) and (32.30, 25.58, -34.84), as Hunt has them.
        const double largest = std::pow(87.73 - 32.30 + std::hypot(75.61 + 25.58, 72.97 + 34.84), 0.7);
        const double expected = 0.95 + 0.05 * (std::pow(100.0, 0.7) - 0.4 * largest) / (0.6 * largest);
        for (const auto v : found.values)
            EXPECT_NEAR(v, expected, 1e-4);
    }

    TEST(flip, is_symmetric_and_between_0_and_1)
    {
        for (const double per_degree : {1.0, 15.0, 67.0, 1000.0}) {
            const auto a = random_picture(25, 20, 4, 1), b = random_picture(25, 20, 4, 2);
            const auto one = flip_difference(a, b, 0, per_degree), other = flip_difference(b, a, 0, per_degree);
            EXPECT_EQ(one.values, other.values);
            for (const auto v : one.values)
                EXPECT_TRUE(v >= 0 && v <= 1) << v;
            EXPECT_GT(one.mean, 0.05);
            EXPECT_EQ(flip_difference(a, a, 0, per_degree).mean, 0);
        }
    }

    TEST(flip, does_not_see_what_the_eye_does_not_resolve)
    {
        image black{61, 61, std::vector<glm::vec3>(61 * 61)}, point = black;
        point.pixels[30 * 61 + 30] = glm::vec3(1);
        const auto largest = [&](double per_degree) {
            const auto map = flip_difference(point, black, 0, per_degree);
            return *std::max_element(map.values.begin(), map.values.end());
        };
        EXPECT_GT(largest(20), 0.8f);
        EXPECT_LT(largest(1000), 0.05f);
        float before = 1;
        for (const double per_degree : {20.0, 67.0, 200.0, 500.0, 1000.0}) {
            const float now = largest(per_degree);
            EXPECT_LT(now, before) << per_degree;
            before = now;
        }
    }

    TEST(flip, grows_with_noise_and_takes_what_is_not_finite_as_black)
    {
        const auto clean = random_picture(40, 30, 0, 1);
        double before = 0;
        for (const float strength : {0.02f, 0.05f, 0.1f, 0.2f, 0.4f}) {
            const double now = flip_difference(random_picture(40, 30, strength, 2), clean).mean;
            EXPECT_GT(now, before) << strength;
            before = now;
        }
        auto a = clean, b = clean;
        a.pixels[37] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
        b.pixels[37] = glm::vec3(0);
        EXPECT_EQ(flip_difference(a, b).mean, 0);
    }

    // At 5 pixels per degree an edge reaches the next pixel, and of colours next to nothing of blue does. White beside
    // one blue or another differs by less than 10^-4 of L*, which may not become visible because the edges differ.
    TEST(flip, sees_no_difference_that_is_next_to_nothing)
    {
        image a{24, 24, std::vector<glm::vec3>(576, glm::vec3(1))}, b = a;
        for (std::size_t i = 0; i < 576; ++i)
            if (i % 24 < 10) {
                const float shade = 0.005f * static_cast<float>(i / 24);
                a.pixels[i] = {0, shade / 2, 1};
                b.pixels[i] = {shade, shade, 1};
            }
        const auto found = flip_difference(a, b, 0, 5);
        for (std::size_t i = 0; i < 576; ++i)
            if (i % 24 >= 10) {
                EXPECT_EQ(found.values[i], 0) << i;
            }
        EXPECT_GT(found.mean, 0.01);
    }

    TEST(flip, refuses_other_sizes_and_pixels_per_degree)
    {
        const auto a = random_picture(4, 3, 0, 1);
        EXPECT_THROW((void)flip_difference(a, random_picture(3, 4, 0, 1)), std::invalid_argument);
        for (const double wrong : {0.0, -1.0, 0.9, 1001.0, std::numeric_limits<double>::quiet_NaN()})
            EXPECT_THROW((void)flip_difference(a, a, 0, wrong), std::invalid_argument) << wrong;
    }

} // namespace
} // namespace photongrid
