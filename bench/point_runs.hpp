// Every n-th run of 64 points: what a search takes for which all points would last too long.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace photongrid::bench {

/// Every `every`-th run of 64 of `points` points, the first run included. `every` is a power of two, so that of two
/// searches one takes all points that the other takes.
struct point_runs {
    static constexpr std::size_t length = 64;
    std::size_t points = 0;
    std::size_t every = 1;

    /// The number of runs.
    std::size_t count() const { return (points + length * every - 1) / (length * every); }
    /// The first point of run r, and the one after its last.
    std::size_t begin(std::size_t r) const { return r * every * length; }
    std::size_t end(std::size_t r) const { return std::min(begin(r) + length, points); }
    /// The number of points in all runs.
    std::size_t taken() const
    {
        return count() == 0 ? 0 : (count() - 1) * length + end(count() - 1) - begin(count() - 1);
    }
};

/// All points if a search for them ends within `seconds_for_all`, else the runs that a search takes in about `seconds`;
/// at least four. `seconds_of_search` searches runs, more and more of them, and returns the seconds that it took.
inline point_runs fitting_runs(std::size_t points, double seconds, double seconds_for_all,
    const std::function<double(const point_runs&)>& seconds_of_search)
{
    point_runs r{points, 1};
    while (r.count() > 4)
        r.every *= 2;
    while (r.every > 1) {
        const double spent = seconds_of_search(r);
        // Few runs may mislead: at most 16 times as many next.
        const std::size_t least = std::max<std::size_t>(r.every / 16, 1);
        std::size_t next = r.every;
        if (spent * static_cast<double>(r.every) <= seconds_for_all)
            next = least;
        else
            for (double expected = 2 * spent; expected <= seconds && next > least; expected *= 2)
                next /= 2;
        if (next == r.every)
            break;
        r.every = next;
    }
    return r;
}

} // namespace photongrid::bench
