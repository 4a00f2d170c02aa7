// photongrid's side of comparisons with peers: photons on the device, and points per second of its searches.
#pragma once

#include "data_sets.hpp"
#include "stopwatch.hpp"

#include <photongrid/estimate/knn_grid_estimate.hpp>

#include <optional>
#include <span>

namespace photongrid::bench {

template <backend B>
photons<B> upload_photons(B& b, const data_set& s)
{
    return {b.upload(std::span<const vec4>(s.positions)), b.upload(std::span<const vec4>(s.powers))};
}

/// Points a second of whole estimates, all points again and again for `seconds`. `e`: the last ones; where there are
/// none yet, one run comes before, to warm up, as a peer has.
template <backend B>
double points_per_second(B& b, const map_buffers<B>& map, const buffer_of<B, vec4>& points,
    const knn_settings& settings, double seconds, std::optional<knn_estimates<B>>& e)
{
    if (!e)
        e = knn_grid_estimate(b, map, points, settings);
    double spent = 0, done = 0;
    for (; spent < seconds; done += static_cast<double>(points.size()))
        spent += seconds_of([&] {
            e = knn_grid_estimate(b, map, points, settings);
            b.finish();
        });
    return done / spent;
}

} // namespace photongrid::bench
