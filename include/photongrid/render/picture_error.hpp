// The error of a picture: how far most of its pixels are from the picture that more passes would converge to, estimated
// from the spread of its passes.
#pragma once

#include <photongrid/render/film.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace detail {
    /// Of the mean radiance of the pixels that count, what is added to the radiance of each before errors are divided
    /// by it, so that pixels that are almost black do not decide.
    inline constexpr double dark_share = 0.01;
    /// Passes whose spread is a smaller part of their mean differ by rounding alone: they show a lamp or a background.
    inline constexpr double least_spread = 1e-6;

    /// Whether a pixel of a mean of passes has noise, and so counts.
    inline bool is_noisy(double mean, double standard_error) { return standard_error > least_spread * std::abs(mean); }

    /// How far a pixel is expected to be from the converged one: a normal number with this mean and deviation, as parts
    /// of the pixel's radiance.
    struct pixel_error_claim {
        double bias = 0, noise = 0; ///< both at least 0
    };

    /// The probability that a pixel differs by more than `bound`.
    inline double probability_beyond(const pixel_error_claim& p, double bound)
    {
        if (!(p.noise > 0))
            return p.bias > bound ? 1 : 0;
        const double unit = std::sqrt(0.5) / p.noise;
        return 0.5 * (std::erfc((bound - p.bias) * unit) + std::erfc((bound + p.bias) * unit));
    }

    /// The claims of the pixels of a picture, in bins: 32 by size to a factor of two, 16 by the part that is bias.
    class error_histogram {
    public:
        void add(const pixel_error_claim& p)
        {
            ++total_;
            const double size = p.bias + p.noise;
            if (size < 0x1p-40)
                ++negligible_;
            else if (size < 0x1p40) {
                const auto by_size = (std::bit_cast<std::uint64_t>(size) >> 47) - first_bin; // 5 bits of mantissa
                const auto by_bias = std::min(static_cast<std::size_t>(p.bias / size * parts), parts - 1);
                auto& b = bins_[by_size * parts + by_bias];
                ++b.count;
                b.bias += p.bias;
                b.noise += p.noise;
            } // else it is beyond every bound
        }
        std::uint64_t total() const { return total_; }
        /// The number of pixels that are expected to differ by more than `bound`.
        double expected_beyond(double bound) const
        {
            double beyond = static_cast<double>(total_ - negligible_);
            for (const auto& b : bins_)
                if (b.count > 0)
                    beyond -= b.count * (1 - probability_beyond({b.bias / b.count, b.noise / b.count}, bound));
            return beyond;
        }

    private:
        struct bin {
            double count = 0, bias = 0, noise = 0; ///< sums
        };
        static constexpr std::size_t parts = 16;
        static constexpr std::uint64_t first_bin = std::bit_cast<std::uint64_t>(0x1p-40) >> 47;
        std::vector<bin> bins_ = std::vector<bin>(80 * 32 * parts);
        std::uint64_t total_ = 0, negligible_ = 0;
    };
} // namespace detail

/// The error of the picture of `sum`: `share` of its pixels is expected to differ by no more from the
/// picture that more passes converge to, as a part of their radiance (mean of the channels) plus 1 % of the picture's.
/// Pixels in which all passes agree do not count. Of a share of 1, as of any that asks for more than half a pixel
/// less than all, the largest difference is as likely above as below. Infinite for fewer than two passes, 0 if all
/// passes agree. A pixel is expected to differ by a normal number: its deviation is the pixel's standard error, its
/// mean the bias that all passes share, 0 if the film has no biases.
inline double picture_error(const film& sum, double share)
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
        const double radiance_of_pixel = std::abs(mean) + dark;
        if (detail::is_noisy(mean, standard_error))
            errors.add({std::abs(sum.bias_of(i)) / radiance_of_pixel, standard_error / radiance_of_pixel});
    });
    const double allowed = std::max((1 - share) * noisy, 0.5);
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

#include <photongrid/core/exact_end.hpp>
