// The noise of the mean of a picture's passes, from sums of passes that follow each other.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// For every pixel the sums of at most 16 groups of passes. A group is 2^n passes that follow each other, of which some
/// may not have been added; n is the smallest that gives so few groups. Passes share out their rays by sequences, so
/// that they are farther from each other than from their mean's goal; but 2^n of them that follow each other are nearly
/// independent of the next 2^n, and their spread tells the noise nearly right. Sums are in fixed point, so that the
/// same passes give the same bits in any order.
class pass_groups {
public:
    static constexpr std::size_t most = 16;
    /// The largest term is below this. 2^16 of them fit.
    static constexpr double largest = 0x1p26;

    pass_groups() = default;
    /// With sums of 0 for `passes`, of so many pixels.
    pass_groups(const std::set<std::uint32_t>& passes, std::size_t pixels) : pixels_(pixels)
    {
        for (const auto pass : passes)
            group_of(pass);
    }

    /// Adds value(i), below `largest`, to pixel i of pass number `pass`, which was not added before.
    template <class Value>
    void add(std::uint32_t pass, const Value& value)
    {
        auto& sums = group_of(pass).sums;
        for (std::size_t i = 0; i < pixels_; ++i)
            sums[i] += rounded(value(i) * steps);
    }
    /// Adds other passes of as many pixels.
    void add(pass_groups other)
    {
        while (level_ < other.level_)
            coarsen();
        while (other.level_ < level_)
            other.coarsen();
        for (auto& [key, theirs] : other.groups_)
            join(groups_, key, std::move(theirs));
        while (groups_.size() > most)
            coarsen();
    }

    /// The variance of the mean of all passes of a pixel. There must be two.
    double variance_of_mean(std::size_t pixel) const
    {
        double passes = 0, sum = 0;
        for (const auto& [key, g] : groups_) {
            passes += g.passes;
            sum += static_cast<double>(g.sums[pixel]);
        }
        double spread = 0;
        for (const auto& [key, g] : groups_) {
            const double difference = static_cast<double>(g.sums[pixel]) / g.passes - sum / passes;
            spread += g.passes * difference * difference;
        }
        return spread / (static_cast<double>(groups_.size() - 1) * passes * steps * steps);
    }

    /// The sums as bytes, for a file that also holds the numbers of the passes.
    void append_to(std::string& out) const
    {
        for (const auto& [key, g] : groups_)
            out.append(reinterpret_cast<const char*>(g.sums.data()), g.sums.size() * sizeof(std::int64_t));
    }
    /// The number of those bytes for a pixel.
    std::size_t bytes_per_pixel() const { return groups_.size() * sizeof(std::int64_t); }
    /// Takes the sums from the front of `in`, which has bytes_per_pixel() for each pixel, or more.
    void take_from(std::string_view& in)
    {
        for (auto& [key, g] : groups_)
            if (const auto size = g.sums.size() * sizeof(std::int64_t); size > 0) {
                std::memcpy(g.sums.data(), in.data(), size);
                in.remove_prefix(size);
            }
    }

private:
    struct group {
        double passes = 0;
        std::vector<std::int64_t> sums;
    };
    using groups = std::map<std::uint32_t, group>; // by the number of their passes over 2^level_

    static constexpr double steps = 0x1p20; ///< of the fixed point, to 1

    static std::int64_t rounded(double x) { return static_cast<std::int64_t>(x + std::copysign(0.5, x)); }

    /// The group of a pass, in which it then counts.
    group& group_of(std::uint32_t pass)
    {
        while (groups_.size() == most && !groups_.contains(pass >> level_))
            coarsen();
        auto& g = groups_[pass >> level_];
        g.sums.resize(pixels_);
        ++g.passes;
        return g;
    }
    /// Makes one group of every two that follow each other.
    void coarsen()
    {
        groups pairs;
        for (auto& [key, g] : groups_)
            join(pairs, key / 2, std::move(g));
        groups_ = std::move(pairs);
        ++level_;
    }
    static void join(groups& all, std::uint32_t key, group&& g)
    {
        auto& to = all[key];
        to.passes += g.passes;
        if (to.sums.empty())
            to.sums = std::move(g.sums);
        else
            for (std::size_t i = 0; i < to.sums.size(); ++i)
                to.sums[i] += g.sums[i];
    }

    std::size_t pixels_ = 0;
    std::uint32_t level_ = 0;
    groups groups_;
};

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
