// Quotients and square roots for devices that round theirs loosely: the functions, as C++, and how kernels come to call
// them. That the functions give the right bits on such a device, its own self-test shows.
#include <photongrid/core/exact_arithmetic.hpp>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <photongrid/core/begin.hpp>
namespace photongrid::exact_functions {
using namespace glm;
#include <photongrid/core/exact_arithmetic.glsl>
} // namespace photongrid::exact_functions
#include <photongrid/core/end.hpp>

namespace photongrid {
namespace {

    /// A number so many units in the last place from x.
    float off(float x, int units) { return std::bit_cast<float>(std::bit_cast<std::int32_t>(x) + units); }

    TEST(exact_arithmetic, rounds_quotients_correctly_from_reciprocals_that_are_off)
    {
        std::mt19937 random(7);
        const auto number = [&](int i) {
            // Any mantissa, or one of those near powers of two, which are the hardest divisors.
            std::uint32_t mantissa = static_cast<std::uint32_t>(random()) >> 9u;
            if (i % 4 == 0)
                mantissa = 0x7FFFFFu - (mantissa & 3u);
            if (i % 4 == 1)
                mantissa &= 3u;
            const auto exponent = static_cast<std::uint32_t>(127 - 38 + static_cast<int>(random() % 77));
            const auto sign = static_cast<std::uint32_t>(random()) & 0x80000000u;
            return std::bit_cast<float>(sign | exponent << 23u | mantissa);
        };
        for (int i = 0; i < 4000000; ++i) {
            const float a = number(i / 4), b = number(i);
            const float reciprocal = off(1.0f / b, i % 7 - 3);
            ASSERT_EQ(exact_functions::refined_quotient(a, b, reciprocal), a / b) << a << " / " << b;
            ASSERT_EQ(exact_functions::exact_quotient(a, b), a / b) << a << " / " << b;
        }
    }

    TEST(exact_arithmetic, rounds_square_roots_correctly_from_ones_that_are_off)
    {
        // Each mantissa of two binades: exponents change nothing else.
        for (std::uint32_t bits = std::bit_cast<std::uint32_t>(1.0f); bits < std::bit_cast<std::uint32_t>(4.0f);
             ++bits) {
            const float x = std::bit_cast<float>(bits), root = std::sqrt(x);
            ASSERT_EQ(exact_functions::refined_root(x, off(root, static_cast<int>(bits % 7u) - 3)), root) << x;
        }
        // Where a step from a neighbour rounds to the wrong side.
        for (const float x : {0x1.000002p+0f, 0x1.000006p+0f, 0x1.aa3b7ep+1f, 0x1.fffffap+1f, 0x1.fffffep+1f})
            for (const int units : {-1, 0, 1})
                EXPECT_EQ(exact_functions::refined_root(x, off(std::sqrt(x), units)), std::sqrt(x))
                    << x << ", " << units;
        for (const float scale : {0x1p-78f, 0x1p-40f, 0x1p60f, 0x1p98f})
            for (std::uint32_t bits = std::bit_cast<std::uint32_t>(1.0f); bits < std::bit_cast<std::uint32_t>(4.0f);
                 bits += 997) {
                const float x = std::bit_cast<float>(bits) * scale;
                ASSERT_EQ(
                    exact_functions::refined_root(x, off(std::sqrt(x), static_cast<int>(bits % 7u) - 3)), std::sqrt(x))
                    << x;
            }
    }

    TEST(exact_arithmetic, takes_powers_of_two_out_of_very_large_and_small_numbers)
    {
        std::mt19937 random(9);
        const float loose = std::numeric_limits<float>::quiet_NaN(), least = std::numeric_limits<float>::min();
        const auto number = [&] { // normal
            const auto bits = static_cast<std::uint32_t>(random());
            return std::bit_cast<float>((bits & 0x807FFFFFu) | (1u + bits % 254u) << 23u);
        };
        std::size_t normal = 0;
        for (int i = 0; i < 1000000; ++i) {
            const float a = number(), b = number(), q = exact_functions::scaled_quotient(a, b, loose);
            ASSERT_EQ(exact_functions::scaled_root(std::abs(a), loose), std::sqrt(std::abs(a))) << a;
            if (std::isinf(a / b) || std::abs(a / b) < least) {
                ASSERT_TRUE(std::isnan(q) || q == a / b) << a << " / " << b; // 2^-126 is what some round up to
            } else {
                ASSERT_EQ(q, a / b) << a << " / " << b;
                ++normal;
            }
        }
        EXPECT_GT(normal, 500000u);
        EXPECT_TRUE(std::isnan(exact_functions::scaled_root(-1.0f, loose)));
    }

    TEST(exact_arithmetic, leaves_what_has_no_exact_residual_to_the_device)
    {
        const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN(),
                    tiny = std::numeric_limits<float>::denorm_min(), huge = std::numeric_limits<float>::max();
        const float numbers[]
            = {0.0f, -0.0f, tiny, -tiny, 1e-38f, 1e-30f, 1.0f, -3.0f, 1e30f, huge, infinity, -infinity, nan};
        for (const float a : numbers) {
            EXPECT_EQ(std::bit_cast<std::uint32_t>(exact_functions::exact_root(std::abs(a))),
                std::bit_cast<std::uint32_t>(std::sqrt(std::abs(a))))
                << a;
            for (const float b : numbers) {
                const float q = exact_functions::exact_quotient(a, b);
                EXPECT_TRUE(std::bit_cast<std::uint32_t>(q) == std::bit_cast<std::uint32_t>(a / b)
                    || (std::isnan(q) && std::isnan(a / b)))
                    << a << " / " << b << ": " << q;
            }
        }
    }

    TEST(exact_arithmetic, is_called_by_kernels_for_their_quotients_and_roots)
    {
        const std::pair<const char*, const char*> rows[] = {
            {"x = a / b;", "x = exact_quotient(a , b);"},
            {"return a/b;", "return exact_quotient(a,b);"},
            {"return -a / b;", "return -exact_quotient(a , b);"},
            {"return (a) / b;", "return exact_quotient((a) , b);"},
            {"a * b / c", "exact_quotient(a * b , c)"},
            {"a / b * c", "exact_quotient(a , b) * c"},
            {"a / b / c", "exact_quotient(exact_quotient(a , b) , c)"},
            {"a / (b / c)", "exact_quotient(a , (exact_quotient(b , c)))"},
            {"a + b / c - d", "a + exact_quotient(b , c) - d"},
            {"a / -b", "exact_quotient(a , -b)"},
            {"a % b / c", "exact_quotient(a % b , c)"},
            {"f(a / b).x / g[i / 2u].yz", "exact_quotient(f(exact_quotient(a , b)).x , g[i / 2u].yz)"},
            {"c ? a / b : d < e / f", "c ? exact_quotient(a , b) : d < exact_quotient(e , f)"},
            {"2.5e-3f * x / 3.0f", "exact_quotient(2.5e-3f * x , 3.0f)"},
            {"1.0f / 3.0f", "1.0f / 3.0f"},
            {".5f / x", "exact_quotient(.5f , x)"},
            {"x /= 2u;", "x /= 2u;"},
            {"const float third = one / 3.0f; float y = x / third;",
                "const float third = one / 3.0f; float y = exact_quotient(x , third);"},
            {"void f() { const float y = x / z; }", "void f() { const float y = exact_quotient(x , z); }"},
            {"sqrt(x) / sqrt (y) + sqrt2", "exact_quotient(exact_root(x) , exact_root (y)) + sqrt2"},
            {"a // b / c\n/ d", "exact_quotient(a // b / c\n, d)"},
            {"a /* b / c */ / d", "exact_quotient(a /* b / c */ , d)"},
            {"#define HALF(x) x / 2.0f\nHALF(y / z)", "#define HALF(x) x / 2.0f\nHALF(exact_quotient(y , z))"},
            {"#if A \\\n / B\na / b", "#if A \\\n / B\nexact_quotient(a , b)"},
            {"if (a / b > c)\n    d = e / f;", "if (exact_quotient(a , b) > c)\n    d = exact_quotient(e , f);"},
            {"float x[4]; x[n / 2u] = a / b;", "float x[4]; x[n / 2u] = exact_quotient(a , b);"},
            {"a ) / b", "a ) / b"},
        };
        for (const auto& [text, expected] : rows)
            EXPECT_EQ(with_exact_arithmetic(text), expected);
    }

} // namespace
} // namespace photongrid
