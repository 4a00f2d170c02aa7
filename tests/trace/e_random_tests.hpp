// Hard cases E: random numbers.
#pragma once

#include "hard_cases.hpp"

namespace photongrid::testing {

// --- E: random numbers
// ------------------------------------------------------------------------------------------------

/// What random_probe.glsl makes of keys.
struct random_numbers {
    std::vector<glm::uvec4> hashes;
    std::vector<glm::vec4> numbers;
    std::vector<float> units;
};
template <class Device>
random_numbers draw_numbers(Device& b, const std::vector<glm::uvec4>& keys)
{
    const auto k = b.upload(std::span<const glm::uvec4>(keys));
    auto h = b.template make<glm::uvec4>(keys.size());
    auto r = b.template make<glm::vec4>(keys.size());
    auto f = b.template make<float>(keys.size());
    b.template run<probes::random_probe>(static_cast<uint>(keys.size()), {.unused = 0u}, reads(k), writes(h, r, f));
    return {b.download(h), b.download(r), b.download(f)};
}

TYPED_TEST_P(hard_cases, e1_random_numbers_stay_below_one)
{
    const uint bits[] = {0u, 1u, 0xFFu, 0x100u, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFF7Fu, 0xFFFFFF80u, 0xFFFFFFFFu};
    std::vector<glm::uvec4> keys;
    for (const uint b : bits)
        keys.emplace_back(b, 0u, 0u, 0u);
    const auto r = draw_numbers(this->b(), keys);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        EXPECT_EQ(r.units[i], static_cast<float>(std::ldexp(static_cast<double>(keys[i].x / 256u), -24))) << keys[i].x;
        EXPECT_LT(r.units[i], 1.0f);
    }
    EXPECT_EQ(r.units.back(), 1 - 0x1p-24f);
}

TYPED_TEST_P(hard_cases, e3_hashes_have_known_answers)
{
    // pcg4d of the JCGT paper, worked out in Python's integers.
    const std::vector<glm::uvec4> keys
        = {glm::uvec4(0u), {1u, 2u, 3u, 4u}, glm::uvec4(0xFFFFFFFFu), {123456789u, 7u, 1u, 20031u}};
    const std::vector<glm::uvec4> known
        = {{0x0F02F829u, 0x2D568769u, 0x32B0C43Bu, 0xD32548EAu}, {0x3622CD16u, 0xF11471D8u, 0xE1109B3Fu, 0x02B94C2Fu},
            {0x974ED892u, 0xC015DC67u, 0x9F955760u, 0xA1BBA208u}, {0x2F4B0C9Eu, 0x2C8A81EDu, 0x6B2E1A85u, 0x7FC237FFu}};
    const auto r = draw_numbers(this->b(), keys);
    EXPECT_EQ(r.hashes, known);
    for (std::size_t i = 0; i < keys.size(); ++i)
        for (int c = 0; c < 4; ++c)
            EXPECT_EQ(static_cast<double>(r.numbers[i][c]), std::ldexp(static_cast<double>(known[i][c] / 256u), -24));
}

/// Chi-squared of pairs over 64 x 64 bins as a standard normal deviate (Wilson and Hilferty).
inline double chi_squared_deviate(const std::vector<std::pair<float, float>>& pairs)
{
    std::vector<double> bins(4096);
    for (const auto& [x, y] : pairs)
        ++bins[static_cast<std::size_t>(x * 64) * 64 + static_cast<std::size_t>(y * 64)];
    const double expected = static_cast<double>(pairs.size()) / 4096;
    double sum = 0;
    for (const double n : bins)
        sum += (n - expected) * (n - expected) / expected;
    const double k = 4095, v = 2 / (9 * k);
    return (std::cbrt(sum / k) - (1 - v)) / std::sqrt(v);
}

TYPED_TEST_P(hard_cases, e3_streams_are_uniform_in_pairs)
{
    // Neighbouring paths, bounces, dimensions and seeds, and the four numbers of a draw: 64 x 64 bins of 262,144 pairs.
    constexpr uint n = 1u << 18;
    double worst = 0;
    const auto keys = [&](auto make) {
        std::vector<glm::uvec4> k(n);
        for (uint i = 0; i < n; ++i)
            k[i] = make(i);
        return draw_numbers(this->b(), k).numbers;
    };
    const auto base = keys([](uint i) { return glm::uvec4(i, 1u, 0u, 1u); });
    const auto compare = [&](const std::string& what, const std::vector<glm::vec4>& other) {
        for (int a = 0; a < 4; ++a)
            for (int c = 0; c < 4; ++c) {
                if (&other == &base && a >= c)
                    continue;
                std::vector<std::pair<float, float>> pairs(n);
                for (uint i = 0; i < n; ++i)
                    pairs[i] = {base[i][a], other[i][c]};
                const double z = chi_squared_deviate(pairs);
                worst = std::max(worst, std::abs(z));
                EXPECT_LE(std::abs(z), 5.0) << what << ", numbers " << a << " and " << c;
            }
    };
    compare("within a draw", base);
    compare("path + 1", keys([](uint i) { return glm::uvec4(i + 1u, 1u, 0u, 1u); }));
    compare("bounce + 1", keys([](uint i) { return glm::uvec4(i, 2u, 0u, 1u); }));
    compare("dimension + 1", keys([](uint i) { return glm::uvec4(i, 1u, 1u, 1u); }));
    compare("seed + 1", keys([](uint i) { return glm::uvec4(i, 1u, 0u, 2u); }));
    this->report("E3", "largest chi-squared deviate of pairs, standard deviations:", worst);
}

/// What sequence_probe.glsl makes of keys and numbers.
template <class Device>
std::vector<glm::vec4> draw_points(Device& b, const std::vector<glm::uvec4>& keys, const std::vector<uint>& nths)
{
    auto four = b.template make<glm::vec4>(keys.size());
    auto two = b.template make<glm::vec4>(keys.size());
    b.template run<probes::sequence_probe>(static_cast<uint>(keys.size()), {.unused = 0u},
        reads(b.upload(std::span<const glm::uvec4>(keys)), b.upload(std::span<const uint>(nths))), writes(four, two));
    const auto points = b.download(four);
    const auto pairs = b.download(two);
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_EQ(glm::vec2(points[i]), glm::vec2(pairs[i])) << "the first pair of four is the sequence of two";
    return points;
}

/// Of 2^m successive points from a multiple of 2^m on, each of the 2^m equal rectangles of each of the m + 1
/// proportions has one: this is what a (0,2)-sequence is. The last block ends with the last number of 32 bits.
TYPED_TEST_P(hard_cases, e4_sequences_have_a_point_in_each_elementary_interval)
{
    for (const uint m : {1u, 3u, 6u, 8u}) {
        const uint n = 1u << m;
        for (const uint first : {0u, n, 7u * n, 0u - n}) {
            std::vector<glm::uvec4> keys;
            std::vector<uint> nths;
            for (uint key = 0; key < 8; ++key)
                for (uint i = 0; i < n; ++i) {
                    keys.emplace_back(key, 3u, 1u, 77u);
                    nths.push_back(first + i);
                }
            const auto points = draw_points(this->b(), keys, nths);
            for (uint key = 0; key < 8; ++key)
                for (uint across = 0; across <= m; ++across) {
                    std::vector<uint> hits(n), others(n);
                    const float columns = static_cast<float>(1u << across), rows = static_cast<float>(n >> across);
                    for (uint i = 0; i < n; ++i) {
                        const auto p = points[std::size_t{key} * n + i];
                        ++hits[static_cast<uint>(p.x * columns) * (n >> across) + static_cast<uint>(p.y * rows)];
                        ++others[static_cast<uint>(p.z * columns) * (n >> across) + static_cast<uint>(p.w * rows)];
                    }
                    ASSERT_EQ(hits, std::vector<uint>(n, 1)) << first << " " << columns << " x " << rows;
                    ASSERT_EQ(others, std::vector<uint>(n, 1)) << first << " " << columns << " x " << rows;
                }
        }
    }
}

/// Each point of a sequence is uniform over keys, and so are its pairs with a point of the same number in another
/// sequence: that of a neighbouring key, or the other pair of the same.
TYPED_TEST_P(hard_cases, e4_sequences_are_independent_of_each_other)
{
    constexpr uint n = 1u << 18;
    double worst = 0;
    for (const uint nth : {0u, 1u, 37u}) {
        const auto points = [&](auto make) {
            std::vector<glm::uvec4> k(n);
            for (uint i = 0; i < n; ++i)
                k[i] = make(i);
            return draw_points(this->b(), k, std::vector<uint>(n, nth));
        };
        const auto base = points([](uint i) { return glm::uvec4(i, 1u, 0u, 1u); });
        const auto compare = [&](const std::string& what, const std::vector<glm::vec4>& other) {
            for (int a = 0; a < 4; ++a)
                for (int c = 0; c < 4; ++c) {
                    if (&other == &base && a >= c)
                        continue;
                    std::vector<std::pair<float, float>> pairs(n);
                    for (uint i = 0; i < n; ++i)
                        pairs[i] = {base[i][a], other[i][c]};
                    const double z = chi_squared_deviate(pairs);
                    worst = std::max(worst, std::abs(z));
                    EXPECT_LE(std::abs(z), 5.0) << what << ", numbers " << a << " and " << c << " of point " << nth;
                }
        };
        compare("within a point", base);
        compare("pixel + 1", points([](uint i) { return glm::uvec4(i + 1u, 1u, 0u, 1u); }));
        compare("dimension + 1", points([](uint i) { return glm::uvec4(i, 1u, 1u, 1u); }));
        compare("seed + 1", points([](uint i) { return glm::uvec4(i, 1u, 0u, 2u); }));
    }
    // Over one sequence of 64 points, four dimensions of two of its keys: 4^4 boxes fill as evenly as at random.
    std::vector<glm::uvec4> keys;
    std::vector<uint> nths;
    for (uint i = 0; i < n; ++i) {
        keys.emplace_back(i / 64u, 1u, 0u, 1u);
        nths.push_back(i % 64u);
    }
    std::vector<double> boxes(256);
    for (const auto& p : draw_points(this->b(), keys, nths))
        ++boxes[static_cast<std::size_t>(p.x * 4) * 64 + static_cast<std::size_t>(p.y * 4) * 16
            + static_cast<std::size_t>(p.z * 4) * 4 + static_cast<std::size_t>(p.w * 4)];
    for (const double count : boxes)
        EXPECT_NEAR(count, n / 256.0, 5 * std::sqrt(n / 256.0));
    this->report("E4", "largest chi-squared deviate of pairs, standard deviations:", worst);
}

TYPED_TEST_P(hard_cases, e6_seeds_are_independent)
{
    // Variance of the mean over P seeds of a path's integrand falls as 1/P: log-log slope -1 +- 0.15.
    constexpr uint seeds = 256, pixels = 4096;
    std::vector<glm::uvec4> k;
    for (uint s = 0; s < seeds; ++s)
        for (uint i = 0; i < pixels; ++i)
            k.emplace_back(i, 1u, 0u, 1u + s);
    const auto r = draw_numbers(this->b(), k).numbers;
    std::vector<double> x, y;
    for (uint passes = 1; passes <= seeds; passes *= 2) {
        double variance = 0;
        for (uint i = 0; i < pixels; ++i) {
            double mean = 0;
            for (uint s = 0; s < passes; ++s) {
                const auto& v = r[std::size_t{s} * pixels + i];
                mean += static_cast<double>(v.x * v.y + (v.z < 0.3f ? v.w : 0.0f)) / passes;
            }
            variance += (mean - 0.4) * (mean - 0.4) / pixels; // 1/4 + 0.3/2
        }
        x.push_back(std::log2(passes));
        y.push_back(std::log2(variance));
    }
    double mx = 0, my = 0, xy = 0, xx = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mx += x[i] / static_cast<double>(x.size());
        my += y[i] / static_cast<double>(x.size());
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        xy += (x[i] - mx) * (y[i] - my);
        xx += (x[i] - mx) * (x[i] - mx);
    }
    this->report("E6", "slope of log variance over log passes:", xy / xx);
    EXPECT_NEAR(xy / xx, -1, 0.15);
}

} // namespace photongrid::testing
