// When a picture of several passes ends: after its last pass, or before by a stop rule (output_settings::until_error
// and seconds). And how long that will take.
#pragma once

#include <photongrid/render/picture_error.hpp>
#include <photongrid/render/render_state.hpp>
#include <photongrid/render/render_stats.hpp>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A stopwatch that can be paused.
class work_clock {
public:
    /// It is paused at `seconds`.
    explicit work_clock(double seconds = 0) : before_(seconds) {}
    void go_on()
    {
        if (!std::exchange(runs_, true))
            since_ = clock::now();
    }
    void pause()
    {
        before_ = seconds();
        runs_ = false;
    }
    /// The time while it ran, s.
    double seconds() const
    {
        return before_ + (runs_ ? std::chrono::duration<double>(clock::now() - since_).count() : 0.0);
    }

private:
    using clock = std::chrono::steady_clock;
    double before_;
    bool runs_ = false;
    clock::time_point since_{};
};

/// What is known of a picture's remaining work.
struct picture_forecast {
    double fraction = 0;                                           ///< done, of the whole picture, 0 to 1
    double seconds_left = std::numeric_limits<double>::infinity(); ///< infinity: not known yet
};

namespace detail {
    /// The largest of 1, 2 and 5 times the powers of ten that is less than x > 0, by more than rounding.
    inline double round_below(double x)
    {
        const double decade = std::pow(10.0, std::ceil(std::log10(x)) - 1);
        for (const double digit : {5.0, 2.0, 1.0})
            if (digit * decade < x * (1 - 1e-9))
                return digit * decade;
        return decade / 2;
    }
} // namespace detail

/// Decides when a picture ends. Times are in s, since the picture was begun.
class picture_judge {
public:
    /// The error of fewer passes is too uncertain to stop by.
    static constexpr std::uint32_t least_passes = 4;

    picture_judge() = default;
    explicit picture_judge(const output_settings& o) : output_(o) {}

    /// Whether and how the picture has ended.
    const end_stats& result() const { return result_; }
    bool ended() const { return result_.by != ended_by::nothing; }

    /// The picture goes on from `sum`.
    void resume(const film& sum, double seconds)
    {
        begun_with_ = sum.passes();
        judge(sum);
        if (sum.passes() > 0)
            before_pass(sum, seconds);
    }
    /// `sum` has one more pass. `stats`: of all passes of this run.
    void after_pass(const film& sum, double seconds, const render_stats& stats)
    {
        const auto own = sum.passes() - begun_with_; // passes of this run
        if (own == 1) {                              // its time has a compilation and previews in it
            pass_seconds_
                = (stats.trace_photons.ms + stats.build_map.ms + stats.trace_rays.ms + stats.radiance_estimate.ms)
                / 1000;
            first_end_ = seconds;
        } else {
            pass_seconds_ = (seconds - first_end_) / (own - 1);
        }
        last_end_ = seconds;
        judge(sum);
    }
    /// Ends the picture if the next pass would end too late. The first pass always begins.
    void before_pass(const film& sum, double seconds)
    {
        if (ended() || output_.seconds == 0 || result_.passes == 0 || seconds + pass_seconds_ < output_.seconds)
            return;
        find_error(sum);
        end(ended_by::seconds);
    }
    /// Ends a picture whose first pass takes too long, once there is something to see.
    void during_pass(double seconds, bool has_picture)
    {
        if (output_.seconds > 0 && result_.passes == 0 && has_picture && seconds >= output_.seconds)
            end(ended_by::seconds);
    }

    /// The mean time of a pass so far, s; 0: there was none in this run.
    double pass_seconds() const { return pass_seconds_; }
    /// When the last pass ended.
    double last_end() const { return last_end_; }
    /// `part`: what is done of the pass that is being drawn, 0 to 1. `pass_seconds`: the time that a pass takes,
    /// infinity if that is unknown.
    picture_forecast forecast(double part, double pass_seconds, double seconds) const
    {
        if (ended())
            return {1, 0};
        picture_forecast f;
        const double done = result_.passes + part, all = passes_needed();
        f.fraction = std::min(done / all, 1.0);
        if (output_.until_error == 0 || result_.passes > 1)
            f.seconds_left = std::max(all - done, 0.0) * pass_seconds;
        if (output_.seconds > 0) {
            f.fraction = std::min(std::max(f.fraction, seconds / output_.seconds), 1.0);
            f.seconds_left = std::max(std::min(f.seconds_left, output_.seconds - seconds), 0.0);
        }
        return f;
    }
    /// Two smaller errors and when more passes would have them, whether or not the picture may have so many:
    /// until_error, if it is not reached yet, and round ones. None as long as the error or the time is unknown.
    /// `since`: the last pass, s.
    std::vector<foreseen_error> foreseen_errors(double pass_seconds, double since) const
    {
        std::vector<foreseen_error> all;
        if (result_.passes < least_passes || !(result_.error > 0) || !std::isfinite(result_.error)
            || !(pass_seconds > 0 && std::isfinite(pass_seconds)))
            return all;
        double error = output_.until_error;
        if (!(error > 0 && error < result_.error))
            error = detail::round_below(0.9 * result_.error);
        for (int i = 0; i < 2; ++i, error = detail::round_below(error)) {
            const double passes = passes_for(error);
            const double seconds = (passes - result_.passes) * pass_seconds - since;
            all.push_back({error, passes, std::max(seconds, 0.0)});
        }
        return all;
    }

private:
    /// Whether the error is found after this pass, because finding it takes time and it hardly changes: where a rule
    /// needs it after each, then after one in sixteen of those before; otherwise whenever their number has doubled.
    bool is_looked_at() const
    {
        const auto passes = result_.passes;
        return output_.has_stop_rule() ? passes % std::bit_floor(std::max(passes / 16, 1u)) == 0
                                       : passes >= least_passes && std::has_single_bit(passes);
    }

    void judge(const film& sum)
    {
        result_.passes = sum.passes();
        const bool last = result_.passes >= output_.passes_at_most();
        if (last || is_looked_at())
            find_error(sum);
        if (output_.until_error > 0 && result_.passes >= least_passes && result_.error <= output_.until_error)
            end(ended_by::error);
        else if (last)
            end(ended_by::passes);
    }
    void find_error(const film& sum)
    {
        if (std::exchange(error_of_, result_.passes) == result_.passes)
            return;
        result_.error = picture_error(sum, output_.percentile);
        errors_.emplace_back(result_.passes, result_.error);
    }
    void end(ended_by by)
    {
        if (!ended())
            result_.by = by;
    }
    /// The rate r at which the error falls as passes^-r: from half as many passes to these. The theory of independent
    /// passes, 1/2, if that is not known: sequences are faster, blur that passes remove is slower.
    double rate_of_error() const
    {
        for (auto then = errors_.rbegin(); then != errors_.rend(); ++then) {
            const auto [passes, error] = *then;
            if (passes >= least_passes && 2 * passes <= error_of_ && std::isfinite(error) && error > result_.error)
                return std::clamp(std::log(error / result_.error) / std::log(1.0 * error_of_ / passes), 0.25, 1.0);
        }
        return 0.5;
    }
    double passes_needed() const
    {
        const double most = output_.passes_at_most();
        if (output_.until_error == 0 || result_.passes < 2)
            return most;
        return std::clamp(passes_for(output_.until_error), std::min(double{least_passes}, most), most);
    }
    /// The number of passes of which the error is to be expected.
    double passes_for(double error) const
    {
        return std::ceil(error_of_ * std::pow(result_.error / error, 1 / rate_of_error()));
    }

    output_settings output_;
    end_stats result_;
    std::uint32_t begun_with_ = 0;
    std::uint32_t error_of_ = 0;                           ///< the number of passes whose error is known
    std::vector<std::pair<std::uint32_t, double>> errors_; ///< passes, their error; of this run
    double pass_seconds_ = 0, first_end_ = 0, last_end_ = 0;
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
