// False colours, and the sheet of a picture's errors, pixel by pixel.
#pragma once

#include "pictures_with_errors.hpp"

#include <photongrid/compare/error_sheet.hpp>
#include <photongrid/compare/false_colors.hpp>
#include <photongrid/io/tone_map.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace photongrid {
namespace {

    double lightness(const glm::vec3& linear) { return detail::cielab(glm::dvec3(linear)).x; }

    TEST(false_colors, become_lighter_evenly)
    {
        for (int i = 0; i <= 64; ++i)
            EXPECT_NEAR(lightness(false_colors::heat(i / 64.0)), 2 + 95 * i / 64.0, 1) << i;
        EXPECT_EQ(false_colors::heat(-3), false_colors::heat(0));
        EXPECT_EQ(false_colors::heat(-std::numeric_limits<double>::infinity()), false_colors::heat(0));
        EXPECT_EQ(false_colors::heat(7), false_colors::heat(1));
    }

    TEST(false_colors, are_blue_below_and_red_above)
    {
        for (int i = 1; i <= 32; ++i) {
            const double t = i / 32.0;
            const auto less = false_colors::balance(-t), more = false_colors::balance(t);
            EXPECT_GT(less.z, less.x) << t;
            EXPECT_GT(more.x, more.z) << t;
            EXPECT_LT(lightness(less), lightness(false_colors::balance(-t + 1 / 32.0))) << t;
            EXPECT_LT(lightness(more), lightness(false_colors::balance(t - 1 / 32.0))) << t;
        }
        EXPECT_GT(lightness(false_colors::balance(0)), 95);
        const double none = std::numeric_limits<double>::quiet_NaN();
        EXPECT_EQ(false_colors::balance(none), false_colors::not_finite);
        EXPECT_EQ(false_colors::heat(none), false_colors::not_finite);
    }

    TEST(error_sheet, limits_differences_by_round_numbers)
    {
        const auto limit = [](double difference, double outlier, std::size_t outliers = 5) {
            std::vector<pixel_error> errors(100, {0, 1 + difference, 0.99});
            for (std::size_t i = 0; i < outliers; ++i)
                errors[i].luminance = 0.99 + outlier;
            errors.push_back({.relative = std::numeric_limits<double>::quiet_NaN()});
            return difference_limit(errors);
        };
        EXPECT_DOUBLE_EQ(limit(-0.01, 100), 0.001); // no difference
        EXPECT_DOUBLE_EQ(limit(0.03, 100), 0.05);
        EXPECT_DOUBLE_EQ(limit(-0.17, 100), 0.2);
        EXPECT_DOUBLE_EQ(limit(0.9, 100), 1);
        EXPECT_DOUBLE_EQ(limit(24, 100), 50);
        EXPECT_DOUBLE_EQ(limit(0.03, 100, 6), 100);
        EXPECT_DOUBLE_EQ(difference_limit({}), 0.001);
    }

    TEST(error_sheet, shows_all_that_was_found)
    {
        // 240 pixels and more are not enlarged; 3 by 2 such pictures are most like a screen.
        const std::uint32_t width = 300, height = 280;
        const auto reference = random_picture(width, height, 0, 1);
        auto picture = random_picture(width, height, 0.2f, 2);
        picture.pixels[5] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
        const auto errors = pixel_errors(picture, reference);
        flip_map visible;
        for (std::size_t i = 0; i < errors.size(); ++i)
            visible.values.push_back(static_cast<float>(i % 100) / 99);
        picture_region one{"one", std::vector<bool>(errors.size())}, other = one;
        for (std::size_t i = 1000; i < 3000; ++i)
            (i < 2000 ? one : other).pixels[i] = true;
        const picture_region regions[] = {one, other};
        const sheet_scales scales{.exposure = 1.5, .least_error = 0.01, .most_error = 10, .difference = 0.5};
        const auto sheet = error_sheet(picture, reference, errors, visible, regions, scales);

        const std::uint32_t across = width + 4, down = height + 4 + 19;
        ASSERT_EQ(sheet.width, 3 * across + 4);
        ASSERT_EQ(sheet.height, 2 * down + 4);
        ASSERT_EQ(sheet.pixels.size(), std::size_t{sheet.width} * sheet.height);
        const auto at = [&](std::uint32_t panel, std::uint32_t x, std::uint32_t y) {
            return sheet.pixels[std::size_t{4 + panel / 3 * down + y} * sheet.width + 4 + panel % 3 * across + x];
        };
        for (const std::size_t i : {0u, 5u, 777u, 1500u, 2500u, 83999u}) {
            const auto x = static_cast<std::uint32_t>(i % width), y = static_cast<std::uint32_t>(i / width);
            const auto shown = [&](const glm::vec3& p) {
                const auto channel = [](float v) { return linear_value(tone_mapped(v, 1.5)); };
                return glm::vec3(channel(p.x), channel(p.y), channel(p.z));
            };
            EXPECT_EQ(at(0, x, y), shown(picture.pixels[i])) << i;
            EXPECT_EQ(at(1, x, y), shown(reference.pixels[i])) << i;
            if (i == 5) {
                for (const std::uint32_t panel : {2u, 3u, 4u, 5u})
                    EXPECT_EQ(at(panel, x, y), false_colors::not_finite) << panel;
                continue;
            }
            EXPECT_EQ(at(2, x, y), false_colors::balance(errors[i].brighter() / 0.5)) << i;
            EXPECT_EQ(at(3, x, y), false_colors::heat((std::log10(errors[i].relative) + 2) / 3)) << i;
            EXPECT_EQ(at(4, x, y), false_colors::heat(static_cast<double>(visible.values[i]))) << i;
            const auto region = at(5, x, y);
            EXPECT_EQ(region.x == region.y && region.y == region.z, i < 1000 || i >= 3000) << i;
        }
        EXPECT_STREQ(region_color_name(0), "blue");
        EXPECT_STREQ(region_color_name(1), "yellow");
        EXPECT_GT(at(5, 0, 5).z, at(5, 0, 5).x);         // pixel 1500
        EXPECT_LT(at(5, 100, 8).z, at(5, 100, 8).x / 4); // pixel 2500

        // The scales' bars begin 4 pixels below, and their ticks 10 below that.
        EXPECT_EQ(at(2, 0, height + 4), false_colors::balance(-1));
        EXPECT_EQ(at(2, width - 1, height + 13), false_colors::balance(1));
        EXPECT_EQ(at(3, 0, height + 4), false_colors::heat(0));
        EXPECT_EQ(at(4, width - 1, height + 4), false_colors::heat(1));
        const auto ticks = [&](std::uint32_t panel) {
            int count = 0;
            for (std::uint32_t x = 0; x < width; ++x)
                count += at(panel, x, height + 14).x > 0.5f && (x == 0 || at(panel, x - 1, height + 14).x < 0.5f);
            return count;
        };
        EXPECT_EQ(ticks(0), 0);
        EXPECT_EQ(ticks(2), 3);
        EXPECT_EQ(ticks(3), 4); // 0.01, 0.1, 1, 10
        EXPECT_EQ(ticks(4), 11);
    }

    TEST(error_sheet, enlarges_small_pictures_and_refuses_others)
    {
        for (const auto& [width, height, columns] :
            {std::tuple{1u, 1u, 3u}, {40u, 30u, 3u}, {60u, 2u, 2u}, {3u, 40u, 6u}}) {
            const auto a = random_picture(static_cast<int>(width), static_cast<int>(height), 0.1f, 1);
            const auto errors = pixel_errors(a, a);
            const flip_map visible{std::vector<float>(a.pixels.size()), 0};
            const auto sheet = error_sheet(a, a, errors, visible, {}, {});
            const std::uint32_t zoom = 240 / width;
            EXPECT_EQ(sheet.width, columns * (zoom * width + 4) + 4) << width;
            EXPECT_EQ(sheet.height, 6 / columns * (zoom * height + 23) + 4) << height;
            EXPECT_EQ(sheet.pixels[4 * sheet.width + 4], sheet.pixels[(3 + zoom) * sheet.width + 3 + zoom]);
            EXPECT_THROW(
                (void)error_sheet(a, random_picture(7, 7, 0, 1), errors, visible, {}, {}), std::invalid_argument);
            EXPECT_THROW((void)error_sheet(a, a, {}, visible, {}, {}), std::invalid_argument);
            const picture_region wrong[] = {{"wrong", {true, false, true}}};
            EXPECT_THROW((void)error_sheet(a, a, errors, visible, wrong, {}), std::invalid_argument);
        }
        EXPECT_THROW((void)error_sheet({}, {}, {}, {}, {}, {}), std::invalid_argument);
    }

} // namespace
} // namespace photongrid
