// Sums that do not depend on the order of their terms, so that passes can be computed by any thread or machine.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A sum of up to 2^16 doubles in fixed point: 128 bits, two's complement, in steps of 2^-64. Each term is rounded to a
/// step once, before it is added; addition is then exact, so any order of the same terms gives the same bits.
class exact_sum {
public:
    static constexpr int fraction_bits = 64; ///< a step is 2^-64
    static constexpr int integer_bits = 46;  ///< of the largest term; 16 more hold the number of terms, one the sign

    /// Whether `x` may be added: it is finite and |x| < 2^46.
    static bool holds(double x) { return std::abs(x) < 0x1p46; } // false for NaN

    /// Adds a term for which holds() is true. 2^16 of the largest terms still fit.
    void add(double x)
    {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        const int biased = static_cast<int>(bits >> 52 & 0x7FF);
        if (biased == 0)
            return; // 0, or much smaller than a step
        const std::uint64_t mantissa = (bits & 0xFFFFFFFFFFFFFu) | 0x10000000000000u;
        const int shift = biased - 1075 + fraction_bits; // x = mantissa * 2^shift steps
        std::uint64_t low = 0, high = 0;
        if (shift >= 64) {
            high = mantissa << (shift - 64);
        } else if (shift >= 0) {
            low = mantissa << shift;
            high = shift == 0 ? 0 : mantissa >> (64 - shift);
        } else if (shift > -54) {
            low = (mantissa + (std::uint64_t{1} << (-shift - 1))) >> -shift; // half a step is rounded away from 0
        }
        if (x < 0) {
            low = ~low + 1;
            high = ~high + (low == 0 ? 1u : 0u);
        }
        add(low, high);
    }
    /// Adds another sum, as if each of its terms were added here.
    void add(const exact_sum& other) { add(other.low_, other.high_); }

    /// The sum, rounded to double.
    double value() const
    {
        const bool negative = (high_ >> 63) != 0;
        const std::uint64_t low = negative ? ~low_ + 1 : low_;
        const std::uint64_t high = negative ? ~high_ + (low == 0 ? 1u : 0u) : high_;
        static_assert(fraction_bits == 64);
        const double size = static_cast<double>(high) + static_cast<double>(low) * 0x1p-64; // ldexp would be a call
        return negative ? -size : size;
    }

    bool operator==(const exact_sum&) const = default; ///< exact

private:
    void add(std::uint64_t low, std::uint64_t high)
    {
        low_ += low;
        high_ += high + (low_ < low ? 1u : 0u);
    }
    std::uint64_t low_ = 0, high_ = 0;
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
