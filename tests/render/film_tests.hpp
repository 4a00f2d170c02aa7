// The sum of a picture's passes.
#pragma once

#include <photongrid/render/film.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace {

using namespace photongrid;

/// A pass of random pixels.
pass_pixels random_pass(std::uint32_t seed, std::size_t n, bool layers)
{
    std::mt19937_64 random(seed);
    std::lognormal_distribution<float> light(0, 2);
    pass_pixels p;
    for (std::size_t i = 0; i < n; ++i) {
        p.pixels.emplace_back(light(random), light(random), light(random), 0);
        const glm::vec4 searches(light(random), light(random), light(random), 2);
        if (layers)
            p.searches.push_back(searches);
        if (layers)
            p.errors.emplace_back(light(random), 0, 0, 0);
    }
    return p;
}

bool same_picture(const image& a, const image& b)
{
    return a.pixels == b.pixels && a.layers.noise == b.layers.noise && a.layers.radius == b.layers.radius
        && a.layers.count == b.layers.count && a.layers.relative_error == b.layers.relative_error;
}

TEST(film, one_pass_is_the_pass_itself)
{
    film f(4, 3, 0.25, true);
    EXPECT_THROW(f.picture(), std::logic_error);
    const auto p = random_pass(1, 12, true);
    f.add(5, p);
    EXPECT_TRUE(f.holds(5));
    EXPECT_FALSE(f.holds(0));
    const auto picture = f.picture().picture;
    for (std::size_t i = 0; i < 12; ++i)
        EXPECT_EQ(picture.pixels[i], glm::vec3(p.pixels[i]));
    EXPECT_TRUE(picture.layers.noise.empty());
}

TEST(film, any_order_of_passes_gives_the_same_bytes)
{
    std::vector<std::uint32_t> order(20);
    std::iota(order.begin(), order.end(), 0u);
    std::mt19937_64 random(7);
    image first;
    std::string bytes;
    for (int turn = 0; turn < 10; ++turn) {
        film f(5, 4, 0x1p-6, true);
        for (const auto pass : order)
            f.add(pass, random_pass(pass, 20, true));
        if (turn == 0) {
            first = f.picture().picture;
            bytes = f.bytes();
        }
        EXPECT_TRUE(same_picture(f.picture().picture, first));
        EXPECT_EQ(f.bytes(), bytes);
        std::shuffle(order.begin(), order.end(), random);
    }
}

/// 50 passes are twelve groups of four and one of two.
TEST(film, is_the_mean_and_its_noise_the_spread_of_groups)
{
    constexpr std::size_t n = 30;
    constexpr std::uint32_t passes = 50, in_group = 4, groups = 13;
    film f(n, 1, 1, true);
    std::vector<glm::dvec3> sums(n, glm::dvec3(0));
    std::vector<std::array<double, groups>> group_sums(n, std::array<double, groups>{});
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const auto p = random_pass(pass, n, true);
        for (std::size_t i = 0; i < n; ++i) {
            const auto value = glm::dvec3(p.pixels[i]);
            sums[i] += value;
            group_sums[i][pass / in_group] += (value.x + value.y + value.z) / 3;
        }
        f.add(pass, p);
    }
    const auto picture = f.picture().picture;
    for (std::size_t i = 0; i < n; ++i) {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(picture.pixels[i][c], sums[i][c] / passes, 1e-6 * sums[i][c] / passes);
        const double mean = (sums[i].x + sums[i].y + sums[i].z) / 3 / passes;
        double variance = 0; // of a pass
        for (std::uint32_t g = 0; g < groups; ++g) {
            const double size = std::min(in_group, passes - g * in_group);
            variance += std::pow(group_sums[i][g] - size * mean, 2) / size / (groups - 1);
        }
        EXPECT_NEAR(picture.layers.noise[i], std::sqrt(variance / passes), 1e-5 * std::sqrt(variance / passes));
    }
}

TEST(film, noise_is_no_less_than_a_quarter_of_what_two_neighbours_have)
{
    // The light differs from pass to pass in three pixels of a row: the two in the middle have neighbours in common.
    constexpr std::uint32_t wide = 7, high = 5, at = 2 * wide;
    film f(wide, high, 1, true);
    std::mt19937_64 random(3);
    std::lognormal_distribution<float> light;
    for (std::uint32_t pass = 0; pass < 16; ++pass) {
        auto p = random_pass(pass, wide * high, true);
        p.pixels.assign(wide * high, glm::vec4(1));
        for (const std::uint32_t x : {0u, 3u, 5u})
            p.pixels[at + x] = glm::vec4(light(random));
        f.add(pass, p);
    }
    const auto noise = f.picture().picture.layers.noise;
    const float told = std::min(noise[at + 3], noise[at + 5]) / 4;
    EXPECT_GT(told, 0.01f);
    for (std::uint32_t i = 0; i < wide * high; ++i) {
        const bool between = i == at + 4 || i == at + 4 - wide || i == at + 4 + wide;
        const bool varies = i == at || i == at + 3 || i == at + 5;
        if (!varies) {
            EXPECT_EQ(noise[i], between ? told : 0.0f) << i << ": one noisy neighbour tells nothing";
        }
    }
}

/// Of passes of one number a pixel: the root mean square of what the film reports as the noise of their mean, and of
/// what it is.
template <class Value>
std::pair<double, double> reported_and_true_noise(std::uint32_t passes, double mean, const Value& value)
{
    constexpr std::size_t n = 4000;
    film f(n, 1, 1, true);
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        pass_pixels p;
        for (std::uint32_t i = 0; i < n; ++i)
            p.pixels.emplace_back(glm::vec3(value(pass, i)), 0);
        p.searches.resize(n);
        p.errors.resize(n);
        f.add(pass, p);
    }
    const auto picture = f.picture().picture;
    double reported = 0, right = 0;
    for (std::size_t i = 0; i < n; ++i) {
        reported += std::pow(picture.layers.noise[i], 2) / n;
        right += std::pow(static_cast<double>(picture.pixels[i].x) - mean, 2) / n;
    }
    return {std::sqrt(reported), std::sqrt(right)};
}

/// However many groups there are, and whatever the last one has.
TEST(film, noise_of_independent_passes_is_right)
{
    for (const std::uint32_t passes : {2u, 5u, 16u, 17u, 33u, 50u, 128u, 200u}) {
        std::mt19937 random(passes);
        std::uniform_real_distribution<float> light(0, 2);
        const auto [reported, right]
            = reported_and_true_noise(passes, 1, [&](std::uint32_t, std::uint32_t) { return light(random); });
        const double known = std::sqrt(1.0 / (3 * passes));
        EXPECT_NEAR(reported, known, 0.05 * known) << passes << " passes"; // five standard errors
        EXPECT_NEAR(right, known, 0.05 * known) << passes << " passes";
    }
}

/// A part of each pixel is covered, and its passes share out their rays: numbers of the van der Corput sequence, turned
/// at random, are in or out. The spread of single passes would tell several times the noise that there is.
TEST(film, noise_of_passes_that_share_out_their_rays_is_nearly_right)
{
    const auto uncovered = [](std::uint32_t pass, std::uint32_t pixel) {
        std::uint32_t reversed = 0;
        for (std::uint32_t bit = 0; bit < 32; ++bit)
            reversed |= (pass >> bit & 1u) << (31 - bit);
        const float covered = 0.2f + static_cast<float>(pixel % 1009) * (0.6f / 1009);
        const std::uint32_t turned = reversed + pixel * 0x9E3779B1u;
        return (static_cast<float>(turned >> 8) * 0x1p-24f < covered ? 1.0f : 0.0f) - covered;
    };
    for (const std::uint32_t passes : {64u, 100u, 256u, 1000u}) {
        const auto [reported, right] = reported_and_true_noise(passes, 0, uncovered);
        const double of_single_passes = std::sqrt(0.22 / passes); // the mean of covered (1 - covered)
        std::printf(
            "[          ] %u passes: the noise that is reported is %.1f of the true one; by single passes %.1f\n",
            passes, reported / right, of_single_passes / right);
        EXPECT_GT(reported, right) << passes << " passes";
        EXPECT_LT(reported, 4.5 * right) << passes << " passes";
        EXPECT_GT(of_single_passes, 6 * right) << passes << " passes";
    }
}

TEST(film, pixels_that_are_not_finite_are_black_in_their_pass_and_counted)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {std::nanf(""), infinity, -infinity}) {
        film f(2, 1, 1, false);
        auto p = random_pass(1, 2, false);
        p.pixels[1] = {bad, 1, 1, 0};
        f.add(0, p);
        EXPECT_EQ(f.picture().invalid_pixels, 1u);
        EXPECT_EQ(f.picture().picture.pixels[1], glm::vec3(0));
        f.add(1, random_pass(2, 2, false));
        EXPECT_EQ(f.picture().invalid_pixels, 1u);
        EXPECT_GT(f.picture().picture.pixels[1].x, 0);
        EXPECT_TRUE(std::isfinite(f.picture().picture.pixels[1].x));
    }
}

/// Light of both signs may cancel in the sum of a pixel's channels, each far too bright to be added.
TEST(film, channels_that_are_too_bright_make_a_pixel_invalid)
{
    film f(2, 1, 1, false);
    auto p = random_pass(1, 2, false);
    p.pixels[0] = {3e38f, -3e38f, 1, 0};
    f.add(0, p);
    const auto q = random_pass(2, 2, false);
    f.add(1, q);
    const auto developed = f.picture();
    EXPECT_EQ(developed.invalid_pixels, 1u);
    for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(developed.picture.pixels[0][c], q.pixels[0][c] / 2);
        EXPECT_NEAR(developed.picture.pixels[1][c], (p.pixels[1][c] + q.pixels[1][c]) / 2, 1e-6f * q.pixels[1][c]);
    }
}

/// A pass whose counts or radii are NaN, infinite or huge has not searched there; such an error is left out alone.
TEST(film, layers_that_are_not_finite_are_left_out_of_their_pass)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {std::nanf(""), infinity, -infinity, 3e38f})
        for (int member = 0; member < 4; ++member)
            for (std::uint32_t of = 0; of < 3; ++of) { // the pass; the first two become sums in another way
                film f(2, 1, 1, true);
                double searches = 0, count = 0, radius = 0, error = 0; // of pixel 1
                for (std::uint32_t pass = 0; pass < 3; ++pass) {
                    auto p = random_pass(pass, 2, true);
                    if (pass == of)
                        (member == 2 ? p.errors[1].x : p.searches[1][member]) = bad; // searches.z is not a layer
                    if (pass != of || member == 2) {
                        searches += static_cast<double>(p.searches[1].w);
                        count += static_cast<double>(p.searches[1].x);
                        radius += static_cast<double>(p.searches[1].y);
                    }
                    if (pass != of)
                        error += static_cast<double>(p.errors[1].x);
                    f.add(pass, p);
                }
                SCOPED_TRACE(testing::Message() << bad << " in member " << member << " of pass " << of);
                const auto& layers = f.picture().picture.layers;
                const auto near = [](float value, double expected) { EXPECT_NEAR(value, expected, 1e-6 * expected); };
                near(layers.count[1], count / searches);
                near(layers.radius[1], radius / searches);
                near(layers.relative_error[1], error / searches / std::sqrt(3.0));
            }
}

TEST(film, layers_of_the_only_pass_are_finite)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {std::nanf(""), infinity, -infinity})
        for (int member = 0; member < 4; ++member) {
            film f(2, 1, 1, true);
            auto p = random_pass(0, 2, true);
            (member == 2 ? p.errors[1].x : p.searches[1][member]) = bad; // searches.z is not a layer
            f.add(0, p);
            SCOPED_TRACE(testing::Message() << bad << " in member " << member);
            const auto& layers = f.picture().picture.layers;
            EXPECT_EQ(layers.count[1], member == 2 ? p.searches[1].x * (1 / p.searches[1].w) : 0.0f);
            EXPECT_EQ(layers.radius[1], member == 2 ? p.searches[1].y * (1 / p.searches[1].w) : 0.0f);
            EXPECT_EQ(layers.relative_error[1], 0.0f);
            EXPECT_EQ(layers.count[0], p.searches[0].x * (1 / p.searches[0].w));
        }
}

// Threads with a film each: whatever their shares, the films add up to the bytes of one that has all passes.
TEST(film, films_of_threads_add_up_to_the_same_bytes)
{
    constexpr std::uint32_t passes = 41;
    for (const bool layers : {false, true}) {
        film all(5, 4, 0x1p-6, layers);
        for (std::uint32_t pass = 0; pass < passes; ++pass)
            all.add(pass, random_pass(pass, 20, layers));
        for (const std::uint32_t threads : {1u, 2u, 5u, 11u}) {
            std::vector<film> own(threads, film(5, 4, 0x1p-6, layers));
            std::vector<std::thread> running;
            for (std::uint32_t t = 0; t < threads; ++t)
                running.emplace_back([&, t] {
                    for (std::uint32_t pass = t; pass < passes; pass += threads)
                        own[t].add(pass, random_pass(pass, 20, layers));
                });
            for (auto& thread : running)
                thread.join();
            for (const bool backwards : {false, true}) {
                film sum(5, 4, 0x1p-6, layers);
                for (std::uint32_t t = 0; t < threads; ++t)
                    sum.add(own[backwards ? threads - 1 - t : t]);
                EXPECT_EQ(sum.passes(), passes);
                EXPECT_EQ(sum.bytes(), all.bytes()) << threads << " threads";
            }
        }
    }
    film sum(5, 4, 0x1p-6, false), other(5, 4, 0x1p-6, false);
    sum.add(3, random_pass(3, 20, false));
    other.add(3, random_pass(3, 20, false));
    const auto before = sum.bytes();
    EXPECT_THROW(sum.add(other), std::invalid_argument) << "the same pass twice";
    EXPECT_THROW(sum.add([] {
        film wider(6, 4, 0x1p-6, false);
        wider.add(1, random_pass(1, 24, false));
        return wider;
    }()),
        std::invalid_argument);
    EXPECT_EQ(sum.bytes(), before);
}

TEST(film, very_bright_and_very_dark_pixels_are_kept)
{
    film f(3, 1, 0x1p-10, true);
    for (std::uint32_t pass = 0; pass < 4; ++pass) {
        auto p = random_pass(pass, 3, true);
        p.pixels[0] = {1e8f, 1e8f, 1e8f, 0};
        p.pixels[1] = {1e-12f, 1e-12f, 1e-12f, 0};
        f.add(pass, p);
    }
    const auto developed = f.picture();
    EXPECT_EQ(developed.invalid_pixels, 0u);
    EXPECT_EQ(developed.picture.pixels[0].x, 1e8f);
    EXPECT_EQ(developed.picture.pixels[1].x, 1e-12f);
    EXPECT_EQ(developed.picture.layers.noise[0], std::numeric_limits<float>::infinity()); // too bright to know
}

TEST(film, throws_for_passes_that_do_not_fit)
{
    film f(4, 3, 1, false);
    f.add(0, random_pass(1, 12, false));
    EXPECT_THROW(f.add(0, random_pass(1, 12, false)), std::invalid_argument);
    EXPECT_THROW(f.add(1, random_pass(1, 11, false)), std::invalid_argument);
    EXPECT_THROW(f.add(1, random_pass(1, 12, true)), std::invalid_argument);
    EXPECT_EQ(f.passes(), 1u);
}

TEST(film, goes_through_bytes)
{
    for (const int passes : {0, 1, 2, 9, 40}) {
        film f(4, 3, 0.5, true);
        for (int pass = 0; pass < passes; ++pass)
            f.add(static_cast<std::uint32_t>(3 * pass), random_pass(static_cast<std::uint32_t>(pass), 12, true));
        const auto bytes = f.bytes();
        auto g = film::from_bytes(bytes);
        EXPECT_EQ(g.bytes(), bytes);
        f.add(200, random_pass(200, 12, true));
        g.add(200, random_pass(200, 12, true));
        EXPECT_TRUE(same_picture(f.picture().picture, g.picture().picture));
        for (std::size_t size = 0; size < bytes.size(); ++size)
            EXPECT_THROW(film::from_bytes(std::string_view(bytes).substr(0, size)), std::invalid_argument) << size;
        EXPECT_THROW(film::from_bytes(bytes + "x"), std::invalid_argument);
    }
}

TEST(film, refuses_a_header_that_no_film_has)
{
    film f(4, 3, 0.5, false);
    const auto with = [&](std::size_t at, auto value) {
        auto bytes = f.bytes();
        std::memcpy(bytes.data() + at, &value, sizeof value);
        return bytes;
    };
    EXPECT_NO_THROW(film::from_bytes(with(0, 16384u)));
    for (const auto& bytes : {with(0, 16385u), with(4, ~0u), with(8, 16u), with(12, 65537u), with(16, 0.0),
             with(16, std::nan("")), with(16, std::numeric_limits<double>::infinity())})
        EXPECT_THROW(film::from_bytes(bytes), std::invalid_argument);
    // Found to be too short before there is memory for its pixels.
    for (std::uint32_t pass = 0; pass < 40; ++pass)
        f.add(pass, random_pass(pass, 12, false));
    auto bytes = with(0, 16384u);
    std::memcpy(bytes.data() + 4, bytes.data(), sizeof(std::uint32_t));
    EXPECT_THROW(film::from_bytes(bytes), std::invalid_argument);
}

} // namespace
