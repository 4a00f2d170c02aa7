// Wall-clock time of work.
#pragma once

#include "median.hpp"

#include <chrono>
#include <functional>
#include <vector>

namespace photongrid::bench {

inline double seconds_of(const std::function<void()>& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

inline double ms_of(const std::function<void()>& work) { return 1000 * seconds_of(work); }

/// Median of three.
inline double median_seconds_of(const std::function<void()>& work)
{
    std::vector<double> all;
    for (int repetition = 0; repetition < 3; ++repetition)
        all.push_back(seconds_of(work));
    return median(all);
}

} // namespace photongrid::bench
