// The error of a picture, and the end of a picture by it or by time, on films whose noise is known.
#pragma once

#include <photongrid/render/picture_end.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace photongrid;

/// Pixels with normal noise that differs from pixel to pixel, and their passes.
struct noisy_picture {
    std::vector<double> truth, sigma;        ///< mean of the channels
    std::vector<std::vector<double>> values; ///< of each pass
    film sum{static_cast<std::uint32_t>(n), 1, 0.25, false};
    std::mt19937_64 random;
    static constexpr std::size_t n = 4000;

    explicit noisy_picture(unsigned seed, double most_noise = 0.3) : random(seed)
    {
        std::lognormal_distribution<double> light(0, 1);
        std::uniform_real_distribution<double> part(0.02, most_noise);
        for (std::size_t i = 0; i < n; ++i) {
            truth.push_back(light(random));
            sigma.push_back(truth.back() * part(random));
        }
    }
    void add_pass()
    {
        std::normal_distribution<double> normal;
        pass_pixels p;
        values.emplace_back();
        for (std::size_t i = 0; i < n; ++i) {
            const auto v = static_cast<float>(truth[i] + sigma[i] * normal(random));
            p.pixels.emplace_back(0.5f * v, v, 1.5f * v, 0);
            values.back().push_back(static_cast<double>(0.5f * v + v + 1.5f * v) / 3);
        }
        sum.add(static_cast<std::uint32_t>(values.size() - 1), p);
    }
    double mean(std::size_t i) const
    {
        double all = 0;
        for (const auto& pass : values)
            all += pass[i];
        return all / static_cast<double>(values.size());
    }
};

/// The bound that a share of normal numbers with these deviations is expected to keep, by bisection over all of them.
double bound_of(const std::vector<double>& deviations, double share)
{
    double low = 0, high = 1e6;
    for (int turn = 0; turn < 200; ++turn) {
        const double middle = (low + high) / 2;
        double within = 0;
        for (const double d : deviations)
            within += std::erf(middle / d / std::sqrt(2.0));
        (within < share * static_cast<double>(deviations.size()) ? low : high) = middle;
    }
    return high;
}

TEST(picture_error, is_what_the_spread_of_each_pixel_says)
{
    noisy_picture p(1);
    EXPECT_EQ(picture_error(p.sum, 0.95), std::numeric_limits<double>::infinity()) << "no pass";
    p.add_pass();
    EXPECT_EQ(picture_error(p.sum, 0.95), std::numeric_limits<double>::infinity()) << "one pass has no spread";
    for (int passes = 2; passes < 20; ++passes) {
        p.add_pass();
        std::vector<double> means, errors;
        double radiance = 0;
        for (std::size_t i = 0; i < p.n; ++i) {
            means.push_back(p.mean(i));
            radiance += std::abs(means[i]) / static_cast<double>(p.n);
        }
        for (std::size_t i = 0; i < p.n; ++i) {
            const int most = passes > 16 ? 2 : 1; // passes of a group; the last may have fewer
            double spread = 0, groups = 0;
            for (int first = 0; first < passes; first += most, ++groups) {
                const int size = std::min(most, passes - first);
                double sum = 0;
                for (int pass = first; pass < first + size; ++pass)
                    sum += p.values[static_cast<std::size_t>(pass)][i];
                spread += (sum / size - means[i]) * (sum / size - means[i]) * size;
            }
            errors.push_back(std::sqrt(spread / (groups - 1) / passes) / (std::abs(means[i]) + 0.01 * radiance));
        }
        for (const double share : {0.3, 0.95, 0.999}) {
            const double expected = bound_of(errors, share);
            EXPECT_NEAR(picture_error(p.sum, share), expected, 1e-3 * expected) << passes << " passes, " << share;
        }
        const double half_a_pixel = bound_of(errors, 1 - 0.5 / static_cast<double>(p.n));
        EXPECT_NEAR(picture_error(p.sum, 1), half_a_pixel, 1e-3 * half_a_pixel);
        EXPECT_LT(picture_error(p.sum, 0), 1e-9);
    }
}

/// The claim: a share of the pixels is within the error of the truth. Few passes know their own noise badly: a pixel's
/// deviation found from n passes is the true one times the root of chi^2 / (n - 1), which makes the claim a few percent
/// larger at 0.95 and smaller at 0.9.
TEST(picture_error, covers_the_share_of_pixels_that_it_names)
{
    for (const int passes : {4, 8, 64})
        for (const double share : {0.9, 0.95}) {
            double within = 0, claimed = 0, expected = 0, known = 0;
            constexpr int pictures = 5;
            for (unsigned seed = 0; seed < pictures; ++seed) {
                noisy_picture p(10 + seed);
                while (p.sum.passes() < static_cast<std::uint32_t>(passes))
                    p.add_pass();
                double radiance = 0;
                for (const double t : p.truth)
                    radiance += t / static_cast<double>(p.n);
                std::vector<double> errors, found;
                std::chi_squared_distribution<double> chi(passes - 1);
                for (std::size_t i = 0; i < p.n; ++i) {
                    errors.push_back(p.sigma[i] / std::sqrt(passes) / (p.truth[i] + 0.01 * radiance));
                    found.push_back(errors.back() * std::sqrt(chi(p.random) / (passes - 1)));
                }
                const double error = picture_error(p.sum, share);
                claimed += error / pictures;
                known += bound_of(errors, share) / pictures;
                expected += bound_of(found, share) / pictures;
                for (std::size_t i = 0; i < p.n; ++i)
                    within += std::abs(p.mean(i) - p.truth[i]) <= error * (p.truth[i] + 0.01 * radiance) ? 1 : 0;
            }
            within /= pictures * static_cast<double>(noisy_picture::n);
            // The mean that the errors are divided by has noise, too.
            EXPECT_NEAR(claimed, expected, 0.03 * expected) << passes << " passes, " << share;
            EXPECT_GT(claimed, 0.95 * known) << passes << " passes, " << share;
            EXPECT_LT(claimed, 1.09 * known) << passes << " passes, " << share;
            // Four standard deviations of a share of so many pixels, and what a claim so far off covers besides.
            const double spread
                = 4 * std::sqrt(share * (1 - share) / (pictures * static_cast<double>(noisy_picture::n)));
            EXPECT_GT(within, share - spread - (passes < 64 ? 0.01 : 0)) << passes << " passes";
            EXPECT_LT(within, share + spread + (passes < 64 ? 0.02 : 0.004)) << passes << " passes";
        }
}

/// A picture with noise and a bias of its own in each pixel.
struct biased_picture {
    static constexpr std::size_t n = 4000;
    std::vector<double> bias, sigma; ///< parts of the light, which is 1
    film sum{static_cast<std::uint32_t>(n), 1, 0.25, false, true};

    /// `of_bias`: the bias in each pixel is at most this part of the light.
    biased_picture(unsigned seed, double of_bias, std::uint32_t passes)
    {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> part(0, 1);
        std::normal_distribution<double> normal;
        for (std::size_t i = 0; i < n; ++i) {
            bias.push_back(of_bias * (2 * part(random) - 1));
            sigma.push_back(0.02 + 0.4 * part(random));
        }
        for (std::uint32_t pass = 0; pass < passes; ++pass) {
            pass_pixels p;
            for (std::size_t i = 0; i < n; ++i) {
                p.pixels.emplace_back(glm::vec3(static_cast<float>(1 + bias[i] + sigma[i] * normal(random))), 0.0f);
                p.biases.bias.emplace_back(glm::vec3(static_cast<float>(bias[i])), 0.0f);
            }
            p.biases.tilt = p.biases.jump = std::vector<glm::vec4>(n, glm::vec4(0));
            sum.add(pass, p);
        }
    }
};

/// Where bias decides, it is the error, and no normal number of its size, which would be beyond it in one pixel of
/// three. Where it is as large as the noise, both count.
TEST(picture_error, has_the_bias_that_all_passes_share)
{
    constexpr std::uint32_t passes = 64;
    for (const double of_bias : {0.0, 0.05, 0.3}) {
        const biased_picture p(4, of_bias, passes);
        std::vector<double> means;
        p.sum.visit_spread([&](double m, double) { means.push_back(m); });
        for (const double share : {0.5, 0.95}) {
            const double error = picture_error(p.sum, share);
            double beyond = 0, within = 0;
            for (std::size_t i = 0; i < p.n; ++i) {
                const double deviation = p.sigma[i] / std::sqrt(double{passes}), bias = std::abs(p.bias[i]),
                             bound = error * (1 + p.bias[i] + 0.01); // a part of the light with its bias
                const auto below = [&](double x) { return 0.5 * std::erfc(-x / deviation / std::sqrt(2.0)); };
                beyond += (1 - below(bound - bias) + below(-bound - bias)) / double{p.n};
                within += std::abs(means[i] - 1) <= bound ? 1.0 / double{p.n} : 0;
            }
            EXPECT_NEAR(beyond, 1 - share, 0.03 * std::min(share, 1 - share) + 0.003) << of_bias;
            EXPECT_NEAR(within, share, 4 * std::sqrt(share * (1 - share) / double{p.n}) + 0.005) << of_bias;
        }
    }
}

/// A lamp and a black background say nothing of the noise beside them, and black pixels with a trace of light little.
TEST(picture_error, counts_pixels_with_noise)
{
    noisy_picture p(3);
    constexpr std::uint32_t others = 40000;
    const auto with_others = [&](const glm::vec4& even, const glm::vec4& odd) {
        film f(static_cast<std::uint32_t>(noisy_picture::n) + others, 1, 0.25, false);
        for (std::uint32_t pass = 0; pass < 16; ++pass) {
            pass_pixels all;
            for (const double v : p.values[pass]) {
                const auto x = static_cast<float>(v);
                all.pixels.emplace_back(x, x, x, 0);
            }
            for (std::uint32_t i = 0; i < others; ++i)
                all.pixels.push_back(pass % 2 == 0 ? even : odd);
            f.add(pass, all);
        }
        return picture_error(f, 0.95);
    };
    while (p.values.size() < 16)
        p.add_pass();
    const double alone = picture_error(p.sum, 0.95);
    EXPECT_NEAR(with_others({0, 0, 0, 0}, {0, 0, 0, 0}), alone, 1e-3 * alone);
    EXPECT_NEAR(with_others({900, 800, 700, 0}, {900, 800, 700, 0}), alone, 1e-3 * alone);
    // Their light is 1e-5 of the picture's, so that their noise is nothing beside 1 %.
    EXPECT_LT(with_others({0, 0, 0, 0}, {1e-5f, 1e-5f, 1e-5f, 0}), alone);
    // All passes agree, or nobody knows.
    film still(2, 1, 1, false), bright(2, 1, 1, false);
    for (std::uint32_t pass = 0; pass < 3; ++pass) {
        still.add(pass, {{{0.1f, 0.7f, 3, 0}, {0, 0, 0, 0}}, {}, {}});
        bright.add(pass, {{{1e9f, 1, 1, 0}, {2e9f, 1, 1, 0}}, {}, {}});
    }
    EXPECT_EQ(picture_error(still, 0.95), 0);
    EXPECT_EQ(picture_error(bright, 0.95), std::numeric_limits<double>::infinity());
}

/// The number of passes with which a rule ends a picture, and how.
end_stats end_of(const output_settings& o, unsigned seed, double pass_seconds, int most)
{
    picture_judge judge(o);
    noisy_picture p(seed, 0.05);
    for (int pass = 0; !judge.ended() && pass < most; ++pass) {
        p.add_pass();
        judge.after_pass(p.sum, (pass + 1) * pass_seconds, {});
        judge.before_pass(p.sum, (pass + 1) * pass_seconds);
    }
    return judge.result();
}

TEST(picture_judge, ends_at_the_first_pass_whose_error_is_small_enough)
{
    output_settings o;
    for (const double error : {0.02, 0.05, 0.8}) {
        o.until_error = error;
        const auto end = end_of(o, 5, 1, 100);
        EXPECT_EQ(end.by, ended_by::error);
        EXPECT_LE(end.error, error);
        noisy_picture p(5, 0.05);
        std::uint32_t expected = 0;
        while (expected < 4 || picture_error(p.sum, 0.95) > error) { // each of the first 32 passes is looked at
            p.add_pass();
            ++expected;
        }
        EXPECT_LE(expected, 31u);
        EXPECT_EQ(end.passes, expected) << error;
        EXPECT_EQ(end.error, picture_error(p.sum, 0.95));
    }
    // Of many passes not each is looked at, but the picture has a sixteenth more than needed at most.
    o.until_error = 0.007;
    const auto end = end_of(o, 5, 1, 400);
    EXPECT_EQ(end.by, ended_by::error);
    EXPECT_GT(end.passes, 100u);
    EXPECT_GT(end.error, 0.007 * std::sqrt(1 - 1.0 / 16) * 0.99);
    // Others may come first.
    o.passes = 7;
    EXPECT_EQ(end_of(o, 5, 1, 400).by, ended_by::passes);
    EXPECT_EQ(end_of(o, 5, 1, 400).passes, 7u);
    o.passes = 1; // no limit
    o.seconds = 12.5;
    EXPECT_EQ(end_of(o, 5, 1, 400).by, ended_by::seconds);
    EXPECT_EQ(end_of(o, 5, 1, 400).passes, 12u);
    o.until_error = o.seconds = 0;
    EXPECT_EQ(end_of(o, 5, 1, 400).passes, 1u);
    EXPECT_EQ(end_of(o, 5, 1, 400).by, ended_by::passes);
}

TEST(picture_judge, begins_no_pass_that_would_end_too_late)
{
    output_settings o;
    o.seconds = 10;
    EXPECT_EQ(end_of(o, 1, 3, 100).passes, 3u);
    EXPECT_EQ(end_of(o, 1, 11, 100).passes, 1u) << "a pass that was begun is finished";
    // The first pass may end within, if there is something to see.
    picture_judge judge(o);
    judge.during_pass(9.9, true);
    EXPECT_FALSE(judge.ended());
    judge.during_pass(10.1, false);
    EXPECT_FALSE(judge.ended());
    judge.during_pass(10.1, true);
    EXPECT_EQ(judge.result().by, ended_by::seconds);
    EXPECT_EQ(judge.result().passes, 0u);
    // A picture that goes on counts the time before.
    noisy_picture p(1);
    p.add_pass();
    p.add_pass();
    picture_judge more(o);
    more.resume(p.sum, 9);
    EXPECT_FALSE(more.ended());
    more.resume(p.sum, 10);
    EXPECT_EQ(more.result().by, ended_by::seconds);
    EXPECT_EQ(more.result().passes, 2u);
    EXPECT_EQ(more.result().error, picture_error(p.sum, 0.95));
    // The second pass of a run tells the time of a pass without what the first had to do besides.
    render_stats first;
    first.trace_photons.ms = 500;
    first.radiance_estimate.ms = 1500;
    picture_judge timed(o);
    noisy_picture q(1);
    q.add_pass();
    timed.resume(q.sum, 0);
    q.add_pass();
    timed.after_pass(q.sum, 7, first);
    EXPECT_EQ(timed.pass_seconds(), 2);
    q.add_pass();
    timed.after_pass(q.sum, 12, first);
    EXPECT_EQ(timed.pass_seconds(), 5);
}

TEST(picture_judge, foresees_the_end)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    output_settings o;
    o.passes = 10;
    noisy_picture p(2);
    picture_judge judge(o);
    EXPECT_EQ(judge.forecast(0, infinity, 1).seconds_left, infinity);
    EXPECT_DOUBLE_EQ(judge.forecast(0.5, 4, 2).seconds_left, 38);
    EXPECT_DOUBLE_EQ(judge.forecast(0.5, 4, 2).fraction, 0.05);
    o.seconds = 20;
    EXPECT_DOUBLE_EQ(picture_judge(o).forecast(0.5, 4, 2).seconds_left, 18);
    EXPECT_DOUBLE_EQ(picture_judge(o).forecast(0.5, 4, 2).fraction, 0.1);
    EXPECT_DOUBLE_EQ(picture_judge(o).forecast(0, infinity, 30).seconds_left, 0);
    // Half the error takes four times the passes.
    o = {};
    picture_judge none(o);
    for (int pass = 0; pass < 8; ++pass)
        p.add_pass();
    o.until_error = picture_error(p.sum, 0.95) / 2.001;
    picture_judge by_error(o);
    EXPECT_EQ(by_error.forecast(0, 4, 0).seconds_left, infinity) << "its error is not known yet";
    by_error.resume(p.sum, 0);
    EXPECT_DOUBLE_EQ(by_error.forecast(0.5, 2, 16).seconds_left, (33 - 8.5) * 2);
    EXPECT_DOUBLE_EQ(by_error.forecast(0.5, 2, 16).fraction, 8.5 / 33);
    o.until_error *= 3;
    picture_judge reached(o);
    reached.resume(p.sum, 0);
    EXPECT_EQ(reached.result().by, ended_by::error);
    EXPECT_EQ(reached.forecast(0.5, 2, 16).seconds_left, 0);
    EXPECT_EQ(reached.forecast(0.5, 2, 16).fraction, 1);
}

TEST(picture_judge, foresees_smaller_errors)
{
    output_settings o;
    o.passes = 9;
    noisy_picture p(2);
    picture_judge judge(o);
    for (int pass = 0; pass < 8; ++pass) {
        EXPECT_TRUE(judge.foreseen_errors(2, 0).empty() || pass >= 4) << "the error is not known yet";
        p.add_pass();
        judge.after_pass(p.sum, 2 * (pass + 1), {});
    }
    const double now = picture_error(p.sum, 0.95);
    ASSERT_EQ(judge.result().error, now);
    EXPECT_TRUE(judge.foreseen_errors(0, 0).empty()) << "no time is known";
    auto foreseen = judge.foreseen_errors(2, 1);
    ASSERT_EQ(foreseen.size(), 2u);
    double above = now;
    for (const auto& f : foreseen) {
        EXPECT_LT(f.error, above);
        EXPECT_GT(f.error, 0.3 * above) << "of 1, 2 and 5 one is near";
        const double digit = f.error / std::pow(10.0, std::floor(std::log10(f.error * (1 + 1e-9))));
        EXPECT_LT(std::min({std::abs(digit - 1), std::abs(digit - 2), std::abs(digit - 5)}), 1e-6) << f.error;
        EXPECT_DOUBLE_EQ(f.seconds, (f.passes - 8) * 2 - 1);
        above = f.error;
    }
    // That many passes have it, whatever the most may be. The sequences of this picture are random numbers.
    EXPECT_GT(foreseen[0].passes, 9) << "more than the picture may have";
    for (int pass = 8; pass < foreseen[0].passes; ++pass)
        p.add_pass();
    EXPECT_NEAR(picture_error(p.sum, 0.95) / foreseen[0].error, 1, 0.25);
    // The error asked for comes first.
    o.until_error = now * 0.37;
    picture_judge asked(o);
    noisy_picture q(2);
    for (int pass = 0; pass < 8; ++pass) {
        q.add_pass();
        asked.after_pass(q.sum, 2 * (pass + 1), {});
    }
    foreseen = asked.foreseen_errors(2, 0);
    ASSERT_EQ(foreseen.size(), 2u);
    EXPECT_EQ(foreseen[0].error, o.until_error);
    EXPECT_LT(foreseen[1].error, o.until_error);
    for (const double x : {1e-9, 0.0099999, 0.01, 0.0100001, 0.02, 0.6, 1.0, 7e12}) {
        EXPECT_LT(detail::round_below(x), x);
        EXPECT_GT(detail::round_below(x), 0.39 * x);
    }
}

/// Half the error takes eight times the passes where it falls with the cube root of them, as blur does.
TEST(picture_judge, foresees_the_end_by_the_rate_at_which_the_error_falls)
{
    output_settings o;
    o.until_error = 0.01;
    picture_judge judge(o);
    film sum(200, 1, 0.25, false, true);
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (std::uint32_t pass = 0; pass < 64; ++pass) {
        const auto bias
            = static_cast<float>(0.1 * (std::cbrt((pass + 1.0) * (pass + 1.0)) - std::cbrt(1.0 * pass * pass)));
        pass_pixels p;
        for (std::size_t i = 0; i < sum.size(); ++i)
            p.pixels.emplace_back(glm::vec3(1 + bias + static_cast<float>(0.001 * normal(random))), 0.0f);
        p.biases.bias = std::vector<glm::vec4>(sum.size(), glm::vec4(bias));
        p.biases.tilt = p.biases.jump = std::vector<glm::vec4>(sum.size(), glm::vec4(0));
        sum.add(pass, p);
        judge.after_pass(sum, pass + 1, {});
    }
    const double error = judge.result().error, needed = 64 * std::pow(error / o.until_error, 3);
    EXPECT_NEAR(judge.forecast(0, 1, 64).seconds_left, needed - 64, 0.2 * needed) << error;
}

} // namespace
