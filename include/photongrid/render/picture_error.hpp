// The error of a picture: how far most of its pixels are from the picture that more passes would converge to, told from
// the spread of its passes.
#pragma once

#include <photongrid/render/film.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

namespace detail {
    /// Of the mean radiance of the pixels that count, what is added to the radiance of each before errors are divided
    /// by it, so that pixels that are almost black do not decide.
    inline constexpr double dark_share = 0.01;
    /// Passes whose spread is a smaller part of their mean differ by rounding alone: they show a lamp or a background.
    inline constexpr double least_spread = 1e-6;

    /// Whether a pixel of a mean of passes has noise, and so counts.
    inline bool is_noisy(double mean, double standard_error) { return standard_error > least_spread * std::abs(mean); }

    /// The error of a pixel: its root mean square difference from the converged pixel, as a part of its radiance plus
    /// `dark`.
    inline double error_of_pixel(double mean, double standard_error, double bias, double dark)
    {
        return std::hypot(standard_error, bias) / (std::abs(mean) + dark);
    }

    /// Numbers by their size, 32 bins to a factor of two: the errors of the pixels of a picture.
    class error_histogram {
    public:
        void add(double error)
        {
            ++total_;
            if (error < 0x1p-40)
                ++negligible_;
            else if (error < 0x1p40) {
                auto& b = bins_[(std::bit_cast<std::uint64_t>(error) >> 47) - first_bin];
                ++b.count;
                b.sum += error;
            } // else it is beyond every bound
        }
        std::uint64_t total() const { return total_; }
        /// The number of pixels that are expected to differ by more than `bound`, if each differs by a normal number of
        /// its size.
        double expected_beyond(double bound) const
        {
            double beyond = static_cast<double>(total_ - negligible_);
            for (const auto& b : bins_)
                if (b.count > 0) {
                    const double count = static_cast<double>(b.count);
                    beyond -= count * std::erf(bound * count / b.sum * std::sqrt(0.5));
                }
            return beyond;
        }

    private:
        struct bin {
            std::uint64_t count = 0;
            double sum = 0;
        };
        static constexpr std::uint64_t first_bin = std::bit_cast<std::uint64_t>(0x1p-40) >> 47; ///< 5 bits of mantissa
        std::vector<bin> bins_ = std::vector<bin>(std::size_t{80} * 32);
        std::uint64_t total_ = 0, negligible_ = 0;
    };
} // namespace detail

/// The error of the picture of `sum`: the share `percentile` of its pixels is expected to differ by no more from the
/// picture that more passes converge to, as a part of their radiance (mean of the channels) plus 1 % of the picture's.
/// Pixels in which all passes agree do not count. Of a percentile of 1, as of any that asks for more than half a pixel
/// less than all, the largest difference is as likely above as below. Infinite for fewer than two passes, 0 if all
/// passes agree. The bias that all passes share is in it if the film tells biases; a pixel then is expected to differ
/// by a normal number with the root of the sum of both squares as its size.
inline double picture_error(const film& sum, double percentile)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (sum.passes() < 2)
        return infinity;
    double radiance = 0, noisy = 0;
    sum.visit_spread([&](double mean, double standard_error) {
        if (detail::is_noisy(mean, standard_error)) {
            radiance += std::abs(mean);
            ++noisy;
        }
    });
    if (noisy == 0)
        return 0;
    const double dark = detail::dark_share * radiance / noisy;
    detail::error_histogram errors;
    std::size_t next = 0;
    sum.visit_spread([&](double mean, double standard_error) {
        const auto i = next++;
        if (detail::is_noisy(mean, standard_error))
            errors.add(detail::error_of_pixel(mean, standard_error, sum.bias_of(i), dark));
    });
    const double allowed = std::max((1 - percentile) * noisy, 0.5);
    double low = -44, high = 44; // powers of 2
    if (errors.expected_beyond(std::exp2(high)) > allowed)
        return infinity;
    while (high - low > 1e-6) {
        const double middle = (low + high) / 2;
        (errors.expected_beyond(std::exp2(middle)) > allowed ? low : high) = middle;
    }
    return std::exp2(high);
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
