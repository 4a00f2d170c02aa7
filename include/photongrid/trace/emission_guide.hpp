// Guided emission: photons leave the lights where paths are known to be useful, as towards a glass ball. A path begins
// with eight random numbers; pilot paths tell in which part of their unit cube paths store photons. The cube is split
// into boxes, dense where paths are useful, and each path draws a box and then its numbers in it. A weight makes up for
// the box's share of the paths, so that every photon's expected power stays the same.
//
// The shares are those of the least expected noise: by box, volume times the root of the rate of useful paths.
#pragma once

#include <photongrid/trace/emission_guide.kernel.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <queue>
#include <span>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The random numbers that a path begins with, each in [0, 1).
using emission_numbers = std::array<float, kernels::EMISSION_NUMBERS>;

/// A box of these numbers, of which a share of the paths draws its own.
struct emission_box {
    emission_numbers low{};  ///< multiples of the size
    emission_numbers size{}; ///< powers of 1/2
    std::uint32_t share = 0; ///< of all paths, in units of 2^-24; at least 1

    /// The product of the sizes.
    double volume() const
    {
        double v = 1;
        for (const float s : size)
            v *= static_cast<double>(s);
        return v;
    }
    /// The factor on the power of paths that begin in this box.
    double weight() const { return volume() / (share * 0x1p-24); }
};

/// Which paths to emit, and how often. With no box each path draws its numbers evenly.
struct emission_guide {
    /// Disjoint, together the whole cube; their shares add to 2^24.
    std::vector<emission_box> boxes;
    /// How many times as many paths even emission would need for the same noise, as far as the pilot paths tell.
    double gain = 1;
    bool has_none_useful = false; ///< no pilot path was useful

    /// The boxes as kernels read them (trace/emission_guide.glsl).
    std::vector<glm::vec4> records() const
    {
        std::vector<glm::vec4> r;
        double below = 0;
        for (const auto& b : boxes) {
            below += b.share;
            r.emplace_back(static_cast<float>(below), static_cast<float>(b.weight()), 0.0f, 0.0f); // exact below 2^24
            for (const auto* numbers : {&b.low, &b.size})
                for (std::size_t i = 0; i < numbers->size(); i += 4)
                    r.emplace_back((*numbers)[i], (*numbers)[i + 1], (*numbers)[i + 2], (*numbers)[i + 3]);
        }
        return r;
    }
};

/// A path that was traced to learn where paths are useful.
struct pilot_path {
    emission_numbers numbers{};
    bool useful = false;
};

namespace detail {
    /// Splits the cube of emission numbers where the rate of useful paths varies.
    class guide_builder {
    public:
        explicit guide_builder(std::span<const pilot_path> paths) : paths_(paths), order_(paths.size())
        {
            for (std::size_t i = 0; i < order_.size(); ++i)
                order_[i] = static_cast<std::uint32_t>(i);
            part whole;
            whole.box.size.fill(1.0f);
            whole.last = order_.size();
            parts_.push_back(examined(whole));
        }

        emission_guide build()
        {
            std::priority_queue<std::pair<double, std::size_t>> best;
            best.emplace(parts_[0].gain, 0);
            while (!best.empty() && best.top().first > 0 && parts_.size() < most_boxes) {
                const auto at = best.top().second;
                best.pop();
                parts_.push_back(split(parts_[at]));
                best.emplace(parts_[at].gain, at);
                best.emplace(parts_.back().gain, parts_.size() - 1);
            }
            return shared_out();
        }

    private:
        static constexpr std::size_t most_boxes = 1024, bins = 16;
        /// A part with fewer paths is not split: its bins would have 4 each.
        static constexpr std::size_t least_paths = 64;
        /// The least chi-squared by which bins differ, of 15 degrees of freedom: exceeded by chance in fewer than one
        /// of 10,000 examinations, so that few of the boxes are split for nothing.
        static constexpr double least_chi2 = 44.3;
        /// The least share of the paths that all boxes get by their volume, so that a weight is at most 10 even where
        /// pilot paths found nothing.
        static constexpr double floor = 0.1;

        struct part {
            emission_box box;
            std::size_t first = 0, last = 0; // of order_
            std::size_t useful = 0;
            std::size_t number = 0; // along which to split it
            double gain = 0;        // expected from splitting it; 0: leave it

            double paths() const { return static_cast<double>(last - first); }
            /// The rate of useful paths, above 0 even if none of few paths was useful.
            double rate() const { return (static_cast<double>(useful) + 0.5) / (paths() + 1); }
            double root() const { return box.volume() * std::sqrt(rate()); }
        };

        /// Counts the useful paths of a part and finds along which number they vary most.
        part examined(part p) const
        {
            std::array<std::array<std::uint32_t, bins>, kernels::EMISSION_NUMBERS> all{}, useful{};
            p.useful = 0;
            for (std::size_t i = p.first; i < p.last; ++i) {
                const auto& path = paths_[order_[i]];
                p.useful += path.useful ? 1 : 0;
                for (std::size_t n = 0; n < all.size(); ++n) {
                    const float in_box = (path.numbers[n] - p.box.low[n]) / p.box.size[n];
                    const auto bin = std::min(static_cast<std::size_t>(in_box * float{bins}), bins - 1);
                    ++all[n][bin];
                    useful[n][bin] += path.useful ? 1 : 0;
                }
            }
            p.gain = 0;
            if (p.useful == 0 || p.paths() < least_paths)
                return p;
            const double mean = static_cast<double>(p.useful) / p.paths();
            double most = least_chi2;
            for (std::size_t n = 0; n < all.size(); ++n) {
                if (p.box.size[n] < 0x1p-16f) // its numbers have few bits left
                    continue;
                double chi2 = 0, roots = 0;
                for (std::size_t bin = 0; bin < bins; ++bin) {
                    const double expected = all[n][bin] * mean, excess = useful[n][bin] - expected;
                    if (expected * (1 - mean) > 0)
                        chi2 += excess * excess / (expected * (1 - mean));
                    roots += std::sqrt((useful[n][bin] + mean) / (all[n][bin] + 1.0)) / bins;
                }
                if (chi2 > most) {
                    most = chi2;
                    p.number = n;
                    p.gain = std::max(p.box.volume() * (std::sqrt(mean) - roots), 1e-300);
                }
            }
            return p;
        }
        /// Halves `p`, which becomes the lower half. Returns the upper one.
        part split(part& p)
        {
            const auto n = p.number;
            const float middle = p.box.low[n] + p.box.size[n] / 2;
            const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
            const auto above = std::stable_partition(
                at(p.first), at(p.last), [&](std::uint32_t path) { return paths_[path].numbers[n] < middle; });
            part upper = p;
            upper.first = p.last = static_cast<std::size_t>(above - order_.begin());
            p.box.size[n] = upper.box.size[n] = p.box.size[n] / 2;
            upper.box.low[n] = middle;
            p = examined(p);
            return examined(upper);
        }

        emission_guide shared_out() const
        {
            double useful = 0, roots = 0;
            for (const auto& p : parts_) {
                useful += p.box.volume() * p.rate();
                roots += p.root();
            }
            emission_guide g;
            double second_moment = 0;
            std::uint32_t left = 1u << 24;
            for (const auto& p : parts_) {
                const double share = (1 - floor) * p.root() / roots + floor * p.box.volume();
                second_moment += p.box.volume() * p.box.volume() * p.rate() / share;
                g.boxes.push_back(p.box);
                g.boxes.back().share = std::max(static_cast<std::uint32_t>(share * 0x1p24), 1u);
                left -= g.boxes.back().share;
            }
            // What rounding left, or, below 0, took too much: at most one unit of each box.
            const auto largest = std::max_element(
                g.boxes.begin(), g.boxes.end(), [](const auto& a, const auto& b) { return a.share < b.share; });
            largest->share += left;
            g.gain = useful / second_moment;
            return g;
        }

        std::span<const pilot_path> paths_;
        std::vector<std::uint32_t> order_; // of the paths; a part's are together
        std::vector<part> parts_;
    };
} // namespace detail

/// The guide that paths suggest which were emitted evenly.
inline emission_guide guide_by(std::span<const pilot_path> paths) { return detail::guide_builder(paths).build(); }

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
