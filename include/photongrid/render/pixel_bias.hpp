// The bias of a pixel over the passes of a picture (docs/design/decisions.md, "The bias is estimated").
#pragma once

#include <photongrid/render/exact_sum.hpp>
#include <photongrid/render/light_step.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec4.hpp>
#include <limits>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The biases of the pixels of one pass: see pixel_biases (canvas.hpp). Empty if they are not reported.
struct pass_biases {
    std::vector<glm::vec4> bias; ///< rgb, W/(m^2 sr)
    std::vector<glm::vec4> tilt; ///< xyz, W/(m^2 sr)
    std::vector<glm::vec4> jump; ///< xyz, W/(m^2 sr)

    std::array<std::vector<glm::vec4>*, 3> parts() { return {&bias, &tilt, &jump}; }
    std::array<const std::vector<glm::vec4>*, 3> parts() const { return {&bias, &tilt, &jump}; }
    /// Whether each has `n` pixels.
    bool have(std::size_t n) const { return bias.size() == n && tilt.size() == n && jump.size() == n; }
};

namespace detail {
    /// The bound of |mean|^2 / variance, for the mean of `passes` plane vectors without a mean of their own, that only
    /// one in 50 exceeds. The ratio has the F distribution with 2 and 2 (passes - 1) degrees of freedom.
    inline double step_bound(double passes)
    {
        const double m = passes - 1;
        return m * (std::pow(50.0, 1 / m) - 1);
    }

    /// What is known of the bias of a pixel from its passes: sums of pass_biases in units, which the caller divides by.
    class pixel_bias_sums {
    public:
        /// The largest term, in units: of squares of three channels, below 2^46.
        static constexpr double largest = 0x1p22;

        /// Adds a pass.
        void add(const glm::dvec4& bias, const glm::dvec4& tilt, const glm::dvec4& jump)
        {
            double brightest = 0;
            for (const auto* v : {&bias, &tilt, &jump})
                for (int c = 0; c < 3; ++c) {
                    if (!std::isfinite((*v)[c]))
                        return; // such a pixel is black in this pass
                    brightest = std::max(brightest, std::abs((*v)[c]));
                }
            if (!(brightest < largest)) {
                unknown_ = 1;
                return;
            }
            const double all = bias.x + bias.y + bias.z;
            for (int c = 0; c < 3; ++c) {
                bias_[c].add(bias[c]);
                tilt_[c].add(tilt[c]);
                jump_[c].add(jump[c]);
            }
            bias_squares_.add(all * all * square_scale);
            jump_squares_.add((jump.x * jump.x + jump.y * jump.y + jump.z * jump.z) * square_scale);
        }
        void add(const pixel_bias_sums& other)
        {
            for (int c = 0; c < 3; ++c) {
                bias_[c].add(other.bias_[c]);
                tilt_[c].add(other.tilt_[c]);
                jump_[c].add(other.jump_[c]);
            }
            bias_squares_.add(other.bias_squares_);
            jump_squares_.add(other.jump_squares_);
            unknown_ |= other.unknown_;
        }

        /// The bias of the mean of the passes by a filter, mean of the channels, in units. Positive: the pixel is too
        /// bright. Its own noise is taken off. Where the light steps within the discs of the estimates, it is that of a
        /// straight step with the moments of the light. Infinite where some pass was too bright to tell.
        double value(double passes, filter_kind filter) const
        {
            if (unknown_ != 0)
                return std::numeric_limits<double>::infinity();
            const double all = bias_[0].value() + bias_[1].value() + bias_[2].value(), mean = all / (3 * passes);
            if (passes < 2)
                return mean; // with its noise
            const double noise2 = variance_of_mean(bias_squares_, all * all, passes) / 9;
            const auto step = step_of(passes, filter);
            const double curve = std::max(std::abs(mean) - step.curve * static_cast<double>(bias_factor(filter)), 0.0);
            return std::copysign(std::sqrt(std::max(curve * curve - noise2, 0.0) + step.bias * step.bias), mean);
        }

    private:
        static constexpr double square_scale = 0x1p-3; ///< so that squares stay below 2^46

        /// Of terms with this sum of squares and this square of their sum.
        static double variance_of_mean(const exact_sum& squares, double square_of_sum, double passes)
        {
            return std::max(squares.value() / square_scale - square_of_sum / passes, 0.0) / (passes * (passes - 1));
        }
        static double dot(const exact_sum (&u)[3], const exact_sum (&v)[3])
        {
            double all = 0;
            for (int c = 0; c < 3; ++c)
                all += u[c].value() * v[c].value();
            return all;
        }
        /// The step of the light that the moments tell of; 0 if noise explains them.
        light_step step_of(double passes, filter_kind filter) const
        {
            const double jumps2 = dot(jump_, jump_), noise2 = variance_of_mean(jump_squares_, jumps2, passes);
            const double tilts2 = dot(tilt_, tilt_);
            if (!(jumps2 > step_bound(passes) * noise2 * passes * passes) || !(tilts2 > 0))
                return {};
            auto step = step_of_ratio(dot(jump_, tilt_) / tilts2, filter);
            const double height = std::sqrt(tilts2) / (passes * step.tilt);
            step.curve *= height;
            step.bias *= height;
            return step;
        }

        exact_sum bias_[3], tilt_[3], jump_[3]; // rgb; xyz; xyz
        exact_sum bias_squares_;                // of the sums of the channels
        exact_sum jump_squares_;                // of the lengths
        std::uint64_t unknown_ = 0;             // 1: in some pass it was too bright. 64 bits: a file has no padding
    };
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
