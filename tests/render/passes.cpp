// Sums of passes, lists of steps and schedules of previews: the parts of a picture, without a device.
#include <photongrid/render/film.hpp>
#include <photongrid/render/previews.hpp>
#include <photongrid/render/step_list.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace {

using namespace photongrid;

/// Doubles of every size that an exact_sum takes, of both signs.
double any_term(std::mt19937_64& random)
{
    const double mantissa = std::uniform_real_distribution<double>(-1, 1)(random);
    return std::ldexp(mantissa, std::uniform_int_distribution<int>(-70, 40)(random));
}

TEST(exact_sum, keeps_what_doubles_lose)
{
    exact_sum sum;
    for (const double x : {0x1p45, 0x1p-80, -0x1p45})
        sum.add(x);
    EXPECT_EQ(sum.value(), 0x1p-80);
    sum.add(-0x1p-80);
    EXPECT_EQ(sum, exact_sum());
    sum.add(-3.0);
    EXPECT_EQ(sum.value(), -3.0);
}

TEST(exact_sum, returns_any_float_of_its_range)
{
    std::mt19937_64 random(1);
    for (int i = 0; i < 100000; ++i) {
        const float mantissa = std::uniform_real_distribution<float>(0.5f, 1)(random);
        const float x = std::ldexp(mantissa, std::uniform_int_distribution<int>(-55, 46)(random)) * (i % 2 ? 1 : -1);
        exact_sum sum;
        sum.add(x);
        ASSERT_EQ(static_cast<float>(sum.value()), x);
    }
}

TEST(exact_sum, says_what_it_holds)
{
    EXPECT_TRUE(exact_sum::holds(0));
    EXPECT_TRUE(exact_sum::holds(-0x1.fffffffffffffp45));
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double x : {0x1p46, -0x1p46, infinity, -infinity, std::nan("")})
        EXPECT_FALSE(exact_sum::holds(x)) << x;
}

RC_GTEST_PROP(exact_sum, does_not_depend_on_order_or_grouping, (std::uint64_t seed))
{
    std::mt19937_64 random(seed);
    std::vector<double> terms(*rc::gen::inRange(0, 60));
    for (auto& x : terms)
        x = any_term(random);
    exact_sum forward, shuffled, left, right;
    for (const double x : terms)
        forward.add(x);
    auto other = terms;
    std::shuffle(other.begin(), other.end(), random);
    for (const double x : other)
        shuffled.add(x);
    for (std::size_t i = 0; i < other.size(); ++i)
        (i % 3 == 0 ? left : right).add(other[i]);
    left.add(right);
    RC_ASSERT(forward == shuffled);
    RC_ASSERT(forward == left);
    // Against long double, which has 64 bits: within the steps that terms were rounded to, its own roundings, and
    // value()'s.
    const long double sum = std::accumulate(terms.begin(), terms.end(), 0.0L);
    RC_ASSERT(
        std::abs(static_cast<double>(sum) - forward.value()) <= std::ldexp(1.0, -80) * static_cast<double>(terms.size())
            + std::ldexp(1.0, 40 - 63 + 6) + std::ldexp(std::abs(forward.value()), -52));
}

/// A pass of random pixels.
pass_pixels random_pass(std::uint32_t seed, std::size_t n, bool layers)
{
    std::mt19937_64 random(seed);
    std::lognormal_distribution<float> light(0, 2);
    pass_pixels p;
    for (std::size_t i = 0; i < n; ++i) {
        p.pixels.emplace_back(light(random), light(random), light(random), 0);
        p.searches.emplace_back(light(random), light(random), light(random), 2);
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

TEST(film, is_the_mean_and_its_noise_the_spread)
{
    constexpr std::size_t n = 30;
    constexpr int passes = 50;
    film f(n, 1, 1, true);
    std::vector<glm::dvec3> sums(n, glm::dvec3(0));
    std::vector<double> squares(n, 0), means(n, 0);
    for (int pass = 0; pass < passes; ++pass) {
        const auto p = random_pass(static_cast<std::uint32_t>(pass), n, true);
        for (std::size_t i = 0; i < n; ++i) {
            const auto value = glm::dvec3(p.pixels[i]);
            const double mean = (value.x + value.y + value.z) / 3;
            sums[i] += value;
            means[i] += mean / passes;
            squares[i] += mean * mean;
        }
        f.add(static_cast<std::uint32_t>(pass), p);
    }
    const auto picture = f.picture().picture;
    for (std::size_t i = 0; i < n; ++i) {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(picture.pixels[i][c], sums[i][c] / passes, 1e-6 * sums[i][c] / passes);
        const double variance = (squares[i] - passes * means[i] * means[i]) / (passes - 1);
        EXPECT_NEAR(picture.layers.noise[i], std::sqrt(variance / passes), 1e-5 * std::sqrt(variance / passes));
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

TEST(film, refuses_what_does_not_fit)
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
    for (const int passes : {0, 1, 2, 9}) {
        film f(4, 3, 0.5, true);
        for (int pass = 0; pass < passes; ++pass)
            f.add(static_cast<std::uint32_t>(3 * pass), random_pass(static_cast<std::uint32_t>(pass), 12, true));
        const auto bytes = f.bytes();
        auto g = film::from_bytes(bytes);
        EXPECT_EQ(g.bytes(), bytes);
        f.add(100, random_pass(100, 12, true));
        g.add(100, random_pass(100, 12, true));
        EXPECT_TRUE(same_picture(f.picture().picture, g.picture().picture));
        for (std::size_t size = 0; size < bytes.size(); ++size)
            EXPECT_THROW(film::from_bytes(std::string_view(bytes).substr(0, size)), std::invalid_argument) << size;
        EXPECT_THROW(film::from_bytes(bytes + "x"), std::invalid_argument);
    }
}

TEST(step_list, runs_steps_in_order_until_each_is_done)
{
    std::string log;
    int left = 0;
    step_list steps;
    steps.then("a", [&] {
        log += 'a';
        return true;
    });
    steps.expand([] { return step_list(); });
    steps.repeat(1, 3, [&](std::uint32_t i) {
        left = 2; // made when it is reached, so that this is not overwritten
        step_list inner;
        inner.then("b", [&, i] {
            log += static_cast<char>('0' + i);
            return --left == 0;
        });
        inner.then("c", [&] {
            log += 'c';
            return true;
        });
        return inner;
    });
    steps.expand([] { return step_list(); });
    EXPECT_FALSE(steps.finished());
    EXPECT_EQ(steps.stage(), "a");
    std::string stages;
    for (int i = 0; !steps.finished(); ++i) {
        ASSERT_LT(i, 100);
        stages += steps.stage();
        steps.advance();
    }
    EXPECT_EQ(log, "a11c22c");
    EXPECT_EQ(stages, "abbcbbc");
    steps.advance();
    EXPECT_EQ(log.size(), 7u);
    EXPECT_TRUE(step_list().finished());
}

TEST(previews, go_from_coarse_to_fine)
{
    render_settings s;
    s.estimate.k = 500;
    const work_costs slow{.ms_per_photon = 1, .ms_per_preview_pixel = 1};
    const auto all = preview_schedule(s, s.map.photons, false, slow, 40);
    const std::vector<preview> expected{{16, 16}, {8, 16}, {4, 16}, {2, 16}, {1, 16}, {1, 4}};
    EXPECT_EQ(all, expected); // 32 pixels along the shorter side are the fewest
    EXPECT_EQ(preview_schedule(s, s.map.photons, true, slow, 40).front(), (preview{8, 16})) << "one was shown already";
    s.estimate.search = search_kind::at_least_k;
    const auto paper = preview_schedule(s, s.map.photons, false, slow, 40);
    EXPECT_EQ(paper, (std::vector<preview>{{16, 16}, {8, 16}, {4, 16}, {2, 16}}));
    s.estimate.search = search_kind::exact_k;
    s.estimate.k = 32;
    EXPECT_EQ(preview_schedule(s, s.map.photons, false, slow, 40).back(), (preview{1, 16}));
}

TEST(previews, are_as_few_as_the_time_allows)
{
    render_settings s;
    const work_costs fast{.ms_per_photon = 1e-9, .ms_per_preview_pixel = 1e-9, .ms_per_pixel = 1e-9};
    EXPECT_TRUE(preview_schedule(s, s.map.photons, false, fast, 40).empty());
    EXPECT_EQ(preview_photons(s, fast, 40), s.map.photons);
    const work_costs quick_previews{.ms_per_photon = 1e-9, .ms_per_preview_pixel = 1e-9};
    EXPECT_EQ(preview_schedule(s, s.map.photons, false, quick_previews, 40), (std::vector<preview>{{1, 16}, {1, 4}}));
}

TEST(previews, trace_fewer_photons_where_that_takes_long)
{
    render_settings s;
    s.map.photons = 1 << 20;
    const work_costs slow{.ms_per_photon = 1};
    EXPECT_EQ(preview_photons(s, slow, 40), (1u << 20) / 64);
    const work_costs medium{.ms_per_photon = 160.0 / (1 << 20)};
    EXPECT_EQ(preview_photons(s, medium, 40), 1u << 19);
    const auto early = preview_schedule(s, s.map.photons / 4, false, slow, 40);
    ASSERT_EQ(early.size(), 1u);
    EXPECT_EQ(early[0].k_divisor, 4u) << "k is smaller already";
    s.map.photons = 1000;
    EXPECT_EQ(preview_photons(s, slow, 40), 1000u) << "few are traced at once";
}

} // namespace
