// A map's searches on the cpu backend beside those of peers, however slow the map is.
#pragma once

#include "data_sets.hpp"
#include "device_searches.hpp"
#include "kth_distances.hpp"
#include "point_runs.hpp"

#include <photongrid/backends/cpu/cpu.hpp>

#include <optional>
#include <span>
#include <vector>

namespace photongrid::bench {

/// A map's search at a set's points: at all of them if that takes at most 10 x `seconds`, otherwise at the runs of them
/// that it takes in `seconds`.
class map_search {
public:
    using map_type = map_buffers<cpu_backend>;

    map_search(cpu_backend& b, const data_set& s, uint k, double seconds)
        : b_(b), set_(s), settings_{.k = k, .max_radius = 1e18f}, seconds_(seconds)
    {
    }

    /// Points per second. The first call chooses the runs.
    double rate(const map_type& map)
    {
        if (!last_) {
            runs_ = fitting_runs(set_.points.size(), seconds_, 10 * seconds_, [&](const point_runs& runs) {
                const auto points = upload(runs);
                return seconds_of([&] { last_ = knn_grid_estimate(b_, map, points, settings_); });
            });
            points_ = upload(runs_);
            last_.reset();
        }
        return points_per_second(b_, map, points_, settings_, seconds_, last_);
    }

    /// The points that were searched for and are known, and those of them whose distance differs.
    struct comparison {
        std::size_t compared = 0, wrong = 0;
    };
    comparison compared_with(kth_distances& known) const
    {
        const auto found = b_.download(last_->irradiance);
        comparison c;
        std::size_t at = 0;
        for_each_point(runs_, [&](std::size_t point) {
            const float distance2 = found[at++].w;
            if (!known.has(point))
                return;
            ++c.compared;
            c.wrong += known.differs(point, distance2) ? 1u : 0u;
        });
        return c;
    }

private:
    template <class Visit>
    static void for_each_point(const point_runs& runs, Visit visit)
    {
        for (std::size_t r = 0; r < runs.count(); ++r)
            for (std::size_t i = runs.begin(r); i < runs.end(r); ++i)
                visit(i);
    }
    cpu_backend::buffer<vec4> upload(const point_runs& runs) const
    {
        std::vector<vec4> points;
        for_each_point(runs, [&](std::size_t i) { points.push_back(set_.points[i]); });
        return b_.upload(std::span<const vec4>(points));
    }

    cpu_backend& b_;
    const data_set& set_;
    knn_settings settings_;
    double seconds_;
    point_runs runs_;
    cpu_backend::buffer<vec4> points_;
    std::optional<knn_estimates<cpu_backend>> last_;
};

} // namespace photongrid::bench
