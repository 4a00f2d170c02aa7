// Exact sums: of any order and grouping, and of every float.
#pragma once

#include <photongrid/render/exact_sum.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace {

using namespace photongrid;

/// Doubles of every size that an exact_sum takes, of both signs.
double any_term(std::mt19937_64& random)
{
    const double mantissa = std::uniform_real_distribution<double>(-1, 1)(random);
    return std::ldexp(mantissa, std::uniform_int_distribution<int>(-54, 40)(random));
}

TEST(exact_sum, keeps_what_doubles_lose)
{
    exact_sum sum;
    for (const double x : {0x1p45, 0x1p-64, -0x1p45})
        sum.add(x);
    EXPECT_EQ(sum.value(), 0x1p-64);
    sum.add(-0x1p-64);
    EXPECT_EQ(sum, exact_sum());
    sum.add(-3.0);
    EXPECT_EQ(sum.value(), -3.0);
}

TEST(exact_sum, returns_any_float_of_its_range)
{
    std::mt19937_64 random(1);
    for (int i = 0; i < 100000; ++i) {
        const float mantissa = std::uniform_real_distribution<float>(0.5f, 1)(random);
        const float x = std::ldexp(mantissa, std::uniform_int_distribution<int>(-39, 46)(random)) * (i % 2 ? 1 : -1);
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

// A picture has up to 2^16 passes.
TEST(exact_sum, holds_the_largest_term_of_every_pass)
{
    constexpr double largest = 0x1.fffffffffffffp45;
    for (const double sign : {1.0, -1.0}) {
        exact_sum sum;
        for (int pass = 0; pass < 65536; ++pass)
            sum.add(sign * largest);
        EXPECT_EQ(sum.value(), sign * largest * 65536);
    }
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
        std::abs(static_cast<double>(sum) - forward.value()) <= std::ldexp(1.0, -64) * static_cast<double>(terms.size())
            + std::ldexp(1.0, 40 - 63 + 6) + std::ldexp(std::abs(forward.value()), -52));
}

} // namespace
