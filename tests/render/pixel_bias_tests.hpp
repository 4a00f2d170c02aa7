// The bias of pixels over the passes of a film, and the error of a picture with it.
#pragma once

#include "film_tests.hpp"

#include <photongrid/render/picture_error.hpp>

namespace {

using namespace photongrid;

/// Passes of pixels that all have a light of 1, a bias of `bias` (each channel) and the given moments, with normal
/// noise.
struct biased_passes {
    double bias = 0, tilt = 0, jump = 0;
    double light_noise = 0.1, bias_noise = 0, moment_noise = 0;
    std::mt19937_64 random{1};
    static constexpr std::uint32_t n = 3000;

    film of(std::uint32_t passes)
    {
        std::normal_distribution<double> normal;
        film f(n, 1, 0.25, false, true);
        for (std::uint32_t pass = 0; pass < passes; ++pass) {
            pass_pixels p;
            for (std::uint32_t i = 0; i < n; ++i) {
                p.pixels.emplace_back(1 + light_noise * normal(random));
                p.biases.bias.emplace_back(bias + bias_noise * normal(random));
                // A direction of its own for each pixel.
                const glm::dvec4 across(std::cos(i), 0, std::sin(i), 0);
                const glm::dvec4 noise(normal(random), 0, normal(random), 0);
                p.biases.tilt.emplace_back(tilt * across + moment_noise * noise);
                p.biases.jump.emplace_back(jump * across + 0.4 * moment_noise * noise);
            }
            f.add(pass, std::move(p));
        }
        return f;
    }
    /// Root mean square over the pixels.
    static double size_of(const film& f)
    {
        double squares = 0;
        for (std::size_t i = 0; i < f.size(); ++i)
            squares += f.bias_of(i) * f.bias_of(i) / n;
        return std::sqrt(squares);
    }
};

TEST(pixel_bias, is_the_mean_of_what_passes_report)
{
    const auto f = biased_passes{.bias = -0.125}.of(5);
    EXPECT_TRUE(f.has_biases());
    for (std::size_t i = 0; i < f.size(); ++i)
        ASSERT_NEAR(f.bias_of(i), -0.125, 1e-12);
    const auto picture = f.picture().picture;
    ASSERT_EQ(picture.layers.bias.size(), f.size());
    EXPECT_EQ(picture.layers.bias[7], -0.125f);
    const auto one = biased_passes{.bias = 0.5}.of(1);
    EXPECT_EQ(one.bias_of(3), 0.5);
    EXPECT_EQ(one.picture().picture.layers.bias[3], 0.5f);
    film without(2, 1, 1, false);
    without.add(0, random_pass(1, 2, false));
    EXPECT_EQ(without.bias_of(1), 0);
    EXPECT_TRUE(without.picture().picture.layers.bias.empty());
}

/// The squares of what is reported have the mean of the square of the bias, but for the half of the noise that is cut
/// off.
TEST(pixel_bias, its_noise_is_no_bias)
{
    constexpr double noise = 0.2, of_mean = noise / 4;
    const double none = biased_passes::size_of(biased_passes{.bias_noise = noise}.of(16));
    EXPECT_LT(none, 0.8 * of_mean); // the noise of the mean, were it not taken off: 1
    const double some = biased_passes::size_of(biased_passes{.bias = 0.15, .bias_noise = noise}.of(16));
    EXPECT_NEAR(some, 0.15, 0.003);
}

/// Moments of a step are found beside noise of their own; noise alone is taken for a step in one pixel of 50.
TEST(pixel_bias, of_a_step_is_half_the_step)
{
    constexpr double pi = 3.14159265358979324, step = 0.5;
    const biased_passes stepping{.tilt = 2 * step / (3 * pi), .jump = step / (9 * pi)};
    EXPECT_NEAR(biased_passes::size_of(biased_passes(stepping).of(4)), step / 2, 1e-6);
    auto noisy = stepping;
    noisy.moment_noise = 0.01;
    EXPECT_NEAR(biased_passes::size_of(noisy.of(16)), step / 2, 0.02);
    // A slope of the light has a tilt only: no bias. Nor has what has a jump without a tilt.
    EXPECT_EQ(biased_passes::size_of(biased_passes{.tilt = 0.1}.of(4)), 0);
    EXPECT_EQ(biased_passes::size_of(biased_passes{.jump = 0.1}.of(4)), 0);
    for (const std::uint32_t passes : {2u, 3u, 6u, 40u}) {
        const auto f = biased_passes{.tilt = 0.2, .moment_noise = 0.1}.of(passes);
        double alarms = 0;
        for (std::size_t i = 0; i < f.size(); ++i)
            alarms += f.bias_of(i) != 0 ? 1 : 0;
        EXPECT_NEAR(alarms / biased_passes::n, 0.02, 4 * std::sqrt(0.02 / biased_passes::n)) << passes;
    }
}

/// What estimates at the middle of a disc see of a step of height 1 at the distance x, by a sum over points of it.
detail::light_step summed_step(double x, filter_kind filter)
{
    constexpr int n = 600;
    detail::light_step sum;
    const auto& entry = detail::entry_of(filter);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double u = (2 * i + 1.0) / n - 1, v = (2 * j + 1.0) / n - 1, t = u * u + v * v;
            if (t >= 1 || u <= x)
                continue;
            const double rho = std::sqrt(t), share = 4.0 / (n * n) / 3.14159265358979324;
            const double weight = filter == filter_kind::constant ? 1
                : filter == filter_kind::cone                     ? 1 - rho
                : filter == filter_kind::epanechnikov             ? 1 - t
                                                                  : (1 - t) * (1 - t);
            sum.tilt += share * u;
            sum.jump += share * u * (1 / rho - 4.0 / 3);
            sum.curve += share * (2 * t - 1);
            sum.bias += share * weight * static_cast<double>(entry.norm);
        }
    return sum;
}

/// At every distance from a step, by every filter, whether radii shrink or not.
TEST(pixel_bias, of_a_step_is_that_at_the_distance_from_it)
{
    for (const auto& entry : filters)
        for (const double shrinks : {1.0, 0.9})
            for (const double d : {0.0, 0.07, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9}) {
                constexpr double height = 0.5;
                film f(1, 1, 0.25, false, true, entry.kind);
                double expected = 0, radius = 1;
                constexpr std::uint32_t passes = 6;
                for (std::uint32_t pass = 0; pass < passes; ++pass, radius *= shrinks) {
                    const auto seen = summed_step(d / radius, entry.kind);
                    const auto factor = static_cast<double>(detail::bias_factor(entry.kind));
                    pass_pixels p;
                    p.pixels.emplace_back(1, 1, 1, 0);
                    p.biases.bias.emplace_back(glm::vec4(static_cast<float>(factor * height * seen.curve)));
                    p.biases.tilt.emplace_back(0, 0, height * seen.tilt, 0);
                    p.biases.jump.emplace_back(0, 0, height * seen.jump, 0);
                    expected += height * seen.bias / passes;
                    f.add(pass, std::move(p));
                }
                // A third of the radius away the jump changes its sign: where radii go through that, noise explains it.
                const double allowed = shrinks < 1 ? 0.4 * expected + 0.01 : 0.01 * expected + 0.003;
                EXPECT_NEAR(f.bias_of(0), expected, allowed) << entry.name << ", " << d << ", radii times " << shrinks;
                film again = film::from_bytes(f.bytes());
                EXPECT_EQ(again.bias_of(0), f.bias_of(0)) << entry.name;
            }
}

TEST(pixel_bias, is_in_the_error_of_a_picture)
{
    // Of normal numbers of deviation 0.1 / 4 about 0.06, 95 % are below 0.06 + 1.645 of these; hardly any is negative.
    const auto error = picture_error(biased_passes{.bias = 0.06}.of(16), 0.95);
    EXPECT_NEAR(error, (0.06 + 1.645 * 0.025) / 1.01, 0.03 * error);
    // Of those about 0, 95 % are within 1.96.
    const auto of_noise = picture_error(biased_passes{}.of(16), 0.95);
    EXPECT_NEAR(of_noise, 1.96 * 0.025 / 1.01, 0.06 * of_noise);
}

TEST(pixel_bias, any_order_of_passes_gives_the_same_bytes_and_goes_through_them)
{
    std::vector<pass_pixels> passes;
    for (std::uint32_t pass = 0; pass < 6; ++pass) {
        passes.push_back(random_pass(pass, 20, false));
        for (auto* part : passes.back().biases.parts())
            *part = random_pass(100 * pass + 7, 20, false).pixels;
    }
    film forwards(5, 4, 0x1p-6, false, true), backwards = forwards, shared[2] = {forwards, forwards};
    for (std::uint32_t pass = 0; pass < 6; ++pass) {
        forwards.add(pass, passes[pass]);
        backwards.add(5 - pass, passes[5 - pass]);
        shared[pass % 2].add(pass, passes[pass]);
        const auto again = film::from_bytes(forwards.bytes());
        EXPECT_EQ(again.bytes(), forwards.bytes());
        EXPECT_EQ(again.picture().picture.layers.bias, forwards.picture().picture.layers.bias);
        EXPECT_TRUE(again.has_biases());
    }
    shared[1].add(std::move(shared[0]));
    EXPECT_EQ(forwards.bytes(), backwards.bytes());
    EXPECT_EQ(forwards.bytes(), shared[1].bytes());
    EXPECT_FALSE(forwards.is_for(5, 4, false, false));
    EXPECT_THROW(forwards.add(6, random_pass(1, 20, false)), std::invalid_argument) << "a pass without biases";
    film without(5, 4, 0x1p-6, false);
    EXPECT_THROW(without.add(0, passes[0]), std::invalid_argument);
    EXPECT_THROW(without.add(forwards), std::invalid_argument);
    EXPECT_THROW((void)film::from_bytes(forwards.bytes().substr(1)), std::invalid_argument);
}

TEST(pixel_bias, that_is_not_finite_is_left_out_and_too_bright_a_one_is_unknown)
{
    for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity(), 1e9f})
        for (int part = 0; part < 3; ++part) {
            film f(2, 1, 1, false, true);
            for (std::uint32_t pass = 0; pass < 4; ++pass) {
                auto p = random_pass(pass, 2, false);
                for (auto* v : p.biases.parts())
                    v->assign(2, {0, 0, 0, 0});
                p.biases.bias[1] = {0.5f, 0.5f, 0.5f, 0};
                if (pass == 2)
                    (*p.biases.parts()[static_cast<std::size_t>(part)])[0].y = bad;
                f.add(pass, p);
            }
            EXPECT_EQ(f.bias_of(0), bad == 1e9f ? std::numeric_limits<double>::infinity() : 0) << part;
            EXPECT_EQ(f.bias_of(1), 0.5);
        }
}

} // namespace
