// Errors of pixels, their statistics and regions, against sorting, counting and pictures whose answers are known.
#pragma once

#include "pictures_with_errors.hpp"

#include <photongrid/compare/error_map.hpp>
#include <photongrid/compare/image_difference.hpp>
#include <photongrid/compare/picture_regions.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

namespace photongrid {
namespace {

    constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

    picture_region whole(const image& picture) { return {"all", std::vector<bool>(picture.pixels.size(), true)}; }

    TEST(error_map, has_the_errors_of_its_definition)
    {
        const auto a = random_picture(31, 17, 0.2f, 1), b = random_picture(31, 17, 0.1f, 2);
        const auto errors = pixel_errors(a, b);
        ASSERT_EQ(errors.size(), a.pixels.size());
        double squares = 0;
        for (std::size_t i = 0; i < errors.size(); ++i) {
            const glm::dvec3 p(a.pixels[i]), q(b.pixels[i]);
            const auto relative = (p - q) / (q + 0.01);
            const double square = (relative.x * relative.x + relative.y * relative.y + relative.z * relative.z) / 3;
            squares += square;
            EXPECT_NEAR(errors[i].relative, std::sqrt(square), 1e-12 * square + 1e-15);
            const auto luminance = [](const glm::dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; };
            EXPECT_NEAR(errors[i].luminance, luminance(p), 1e-12);
            EXPECT_NEAR(errors[i].reference, luminance(q), 1e-12);
            EXPECT_NEAR(errors[i].brighter(), (luminance(p) - luminance(q)) / (luminance(q) + 0.01), 1e-9);
        }
        const auto count = static_cast<double>(errors.size());
        const auto s = summary_of(errors, std::vector<float>(errors.size(), 0.25f), whole(a));
        EXPECT_NEAR(s.relmse, squares / count, 1e-12 * squares);
        EXPECT_NEAR(s.relmse, compare_images(a, b).relmse, 1e-9 * s.relmse);
        EXPECT_EQ(s.flip, 0.25);
        EXPECT_THROW((void)pixel_errors(a, random_picture(17, 31, 0, 1)), std::invalid_argument);
    }

    TEST(error_map, leaves_the_worst_out_and_has_percentiles)
    {
        for (const std::size_t count : {1u, 2u, 3u, 99u, 100u, 101u, 1000u, 1001u, 2500u}) {
            std::mt19937 random(7);
            std::exponential_distribution<double> e(1);
            std::vector<pixel_error> errors(count);
            for (auto& pixel : errors)
                pixel.relative = e(random);
            auto sorted = errors;
            std::sort(
                sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.relative < b.relative; });
            const std::map<std::size_t, std::size_t> left_out{{1, 0}, {1001, 2}, {2500, 3}};
            const auto found = left_out.find(count);
            const std::size_t kept = count - (found == left_out.end() ? 1 : found->second);
            double sum = 0;
            for (std::size_t i = 0; i < kept; ++i)
                sum += sorted[i].relative * sorted[i].relative;
            const auto s = summary_of(errors, std::vector<float>(count), {"all", std::vector<bool>(count, true)});
            EXPECT_NEAR(s.trimmed_relmse, sum / static_cast<double>(kept), 1e-12) << count;
            for (std::size_t i = 0; i < error_percentiles.size(); ++i) {
                const double value = s.percentiles[i], share = error_percentiles[i] / 100.0;
                std::size_t below = 0, at_most = 0;
                for (const auto& pixel : errors) {
                    below += pixel.relative < value;
                    at_most += pixel.relative <= value;
                }
                EXPECT_GE(static_cast<double>(at_most), share * static_cast<double>(count)) << count;
                EXPECT_LT(static_cast<double>(below), share * static_cast<double>(count)) << count;
            }
        }
    }

    TEST(error_map, counts_by_half_decades)
    {
        std::mt19937 random(3);
        std::uniform_real_distribution<double> power(-6, 4);
        std::vector<pixel_error> errors(500);
        for (auto& pixel : errors)
            pixel.relative = std::pow(10, power(random));
        errors.push_back({.relative = 0});
        errors.push_back({.relative = std::numeric_limits<double>::quiet_NaN()});
        const auto bins = error_histogram(errors);
        ASSERT_EQ(bins.size(), 14u);
        EXPECT_EQ(bins.front().from, 0);
        EXPECT_NEAR(bins.front().to, 1e-4, 1e-18);
        EXPECT_EQ(bins.back().to, std::numeric_limits<double>::infinity());
        std::uint64_t pixels = 0;
        double squares = 0, expected_squares = 0;
        for (std::size_t i = 0; i < bins.size(); ++i) {
            std::uint64_t expected = 0;
            for (const auto& pixel : errors)
                if (const double at = 2 * std::log10(pixel.relative) + 8; at >= static_cast<double>(i) - 1 || i == 0)
                    expected += at < static_cast<double>(i) || i + 1 == bins.size() ? 1 : 0;
            EXPECT_EQ(bins[i].pixels, expected) << i;
            pixels += bins[i].pixels;
            squares += bins[i].squares;
        }
        EXPECT_EQ(pixels, 501u);
        for (const auto& pixel : errors)
            expected_squares += std::isnan(pixel.relative) ? 0 : pixel.relative * pixel.relative;
        EXPECT_NEAR(squares, expected_squares, 1e-9 * squares);
    }

    TEST(error_map, tells_noise_from_bias_and_one_region_from_another)
    {
        image b{10, 10, std::vector<glm::vec3>(100, glm::vec3(2))}, a = b;
        picture_region left{"left", std::vector<bool>(100)}, right = left;
        for (std::size_t i = 0; i < 100; ++i) {
            const bool is_left = i % 10 < 5;
            (is_left ? left : right).pixels[i] = true;
            a.pixels[i] = glm::vec3(is_left ? (i % 2 == 0 ? 1.5f : 2.5f) : 1.9f);
        }
        a.pixels[0] = a.pixels[5] = b.pixels[9] = glm::vec3(not_a_number);
        const auto errors = pixel_errors(a, b);
        std::vector<float> visible(100);
        for (std::size_t i = 0; i < 100; ++i)
            visible[i] = left.pixels[i] ? 0.5f : 0.125f;
        const auto l = summary_of(errors, visible, left), r = summary_of(errors, visible, right),
                   all = summary_of(errors, visible, whole(a));
        EXPECT_EQ(l.pixels, 49u);
        EXPECT_EQ(r.pixels, 48u);
        EXPECT_EQ(all.pixels, 97u);
        EXPECT_NEAR(l.relmse, 0.25 / (2.01 * 2.01), 1e-9);
        EXPECT_NEAR(r.relmse, 0.01 / (2.01 * 2.01), 1e-8);
        EXPECT_NEAR(l.bias(), (29 * 1.5 + 20 * 2.5) / 49 / 2 - 1, 1e-9);
        EXPECT_NEAR(r.bias(), -0.05, 1e-7);
        EXPECT_NEAR(l.squares + r.squares, all.squares, 1e-12);
        EXPECT_EQ(l.flip, 0.5);
        EXPECT_EQ(r.flip, 0.125);
        const auto none = summary_of(errors, visible, {"none", std::vector<bool>(100)});
        EXPECT_EQ(none.pixels, 0u);
        EXPECT_EQ(none.squares, 0);
        for (const double v :
            {none.relmse, none.trimmed_relmse, none.mean, none.bias(), none.flip, none.percentiles[0]})
            EXPECT_TRUE(std::isnan(v));
    }

    /// A picture of even columns.
    image columns(std::uint32_t width, std::uint32_t height, const std::function<float(std::uint32_t)>& value)
    {
        image picture{width, height, {}};
        for (std::uint32_t i = 0; i < width * height; ++i)
            picture.pixels.emplace_back(value(i % width));
        return picture;
    }
    const std::vector<bool>& named(const std::vector<picture_region>& regions, const std::string& name)
    {
        return std::find_if(regions.begin(), regions.end(), [&](const auto& r) { return r.name == name; })->pixels;
    }

    TEST(picture_regions, find_steps_of_a_factor)
    {
        const auto step
            = [](float factor) { return columns(24, 9, [=](std::uint32_t x) { return x < 12 ? 1.0f : factor; }); };
        for (const float factor : {1.6f, 0.6f, 30.0f}) {
            const auto regions = regions_of(step(factor));
            for (std::size_t i = 0; i < 24 * 9; ++i) {
                const bool near = i % 24 >= 9 && i % 24 <= 14; // 11 and 12 are beside the step
                EXPECT_EQ(named(regions, "edges")[i], near) << factor << ' ' << i % 24;
                EXPECT_EQ(named(regions, "surfaces")[i], !near);
            }
        }
        const auto none = [](const image& picture) {
            const auto regions = regions_of(picture);
            const auto& edges = named(regions, "edges");
            return std::find(edges.begin(), edges.end(), true) == edges.end();
        };
        EXPECT_TRUE(none(step(1.4f)));
        EXPECT_FALSE(none(step(1.55f)));
        EXPECT_TRUE(none(columns(24, 9, [](std::uint32_t x) { return std::pow(1.2f, static_cast<float>(x)); })));
        auto noisy = random_picture(40, 30, 0.1f, 5);
        const auto smooth = random_picture(40, 30, 0, 5);
        for (std::size_t i = 0; i < noisy.pixels.size(); ++i)
            noisy.pixels[i] += glm::vec3(0.5f) - smooth.pixels[i]; // even but for noise
        noisy.pixels[700] = noisy.pixels[300] = glm::vec3(1000);   // single bright paths
        noisy.pixels[500] = glm::vec3(not_a_number);
        EXPECT_TRUE(none(noisy));
    }

    TEST(picture_regions, are_dark_and_bright_by_two_stops)
    {
        for (const float unit : {1.0f, 1e-3f, 40.0f}) { // the geometric mean of the first three is their middle
            const auto regions = regions_of(columns(40, 8, [=](std::uint32_t x) {
                return x < 10 ? unit / 4.5f : x < 20 ? unit : x < 30 ? unit * 4.5f : unit;
            }));
            for (std::size_t i = 0; i < 320; ++i) {
                const auto x = i % 40;
                EXPECT_EQ(named(regions, "dark")[i], x < 10) << unit << ' ' << x;
                EXPECT_EQ(named(regions, "bright")[i], x >= 20 && x < 30) << unit << ' ' << x;
            }
        }
        const auto mild = regions_of(columns(20, 8, [](std::uint32_t x) { return x < 10 ? 1.0f : 14.0f; }));
        for (std::size_t i = 0; i < 160; ++i) // sqrt(14) is less than 4
            EXPECT_TRUE(named(mild, "middle")[i]);
        const auto black = regions_of(columns(6, 6, [](std::uint32_t) { return 0.0f; }));
        EXPECT_TRUE(named(black, "dark")[0]);
    }

    TEST(picture_regions, have_every_finite_pixel_once)
    {
        auto picture = random_picture(33, 21, 0.4f, 9);
        picture.pixels[40] = glm::vec3(0, std::numeric_limits<float>::infinity(), 0);
        const auto regions = regions_of(picture);
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
            const auto count = [&](std::initializer_list<const char*> names) {
                int n = 0;
                for (const auto* name : names)
                    n += named(regions, name)[i] ? 1 : 0;
                return n;
            };
            EXPECT_EQ(count({"edges", "surfaces"}), i == 40 ? 0 : 1);
            EXPECT_EQ(count({"dark", "middle", "bright"}), i == 40 ? 0 : 1);
        }
    }

    TEST(picture_regions, come_from_other_pictures)
    {
        // Means: 0.4 of the finite ones.
        image light{5, 2, std::vector<glm::vec3>(10)};
        light.pixels[1] = light.pixels[7] = glm::vec3(1.6f);
        light.pixels[2] = glm::vec3(0.39f);
        light.pixels[3] = glm::vec3(0.01f);
        light.pixels[9] = glm::vec3(not_a_number);
        const auto lit = region_of("caustics", light, 0.1, false).pixels,
                   unlit = region_of("s", light, 0.1, true).pixels;
        for (std::size_t i = 0; i < 10; ++i) {
            const bool bright = i == 1 || i == 7 || i == 2;
            EXPECT_EQ(lit[i], bright) << i;
            EXPECT_EQ(unlit[i], !bright && i != 9) << i;
        }
        EXPECT_FALSE(region_of("c", light, 1, false).pixels[2]);
        EXPECT_TRUE(region_of("c", light, 0, false).pixels[3]);
        const image black{2, 2, std::vector<glm::vec3>(4)}, grey{2, 2, std::vector<glm::vec3>(4, glm::vec3(1))};
        EXPECT_THROW((void)region_of("c", black, 0.1, false), std::invalid_argument);
        EXPECT_THROW((void)region_of("c", grey, 0.1, true), std::invalid_argument);
        EXPECT_THROW((void)region_of("c", {1, 1, {glm::vec3(not_a_number)}}, 0.1, true), std::invalid_argument);
    }

} // namespace
} // namespace photongrid
