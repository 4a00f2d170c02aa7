// The stages of a pass in order: figure 1 of the paper.
//
//     world  -> trace_photons -> build_map ---------------------------+
//     camera -> trace_eye -> direct_light -> irradiance (2.3) -> shade -> film
//
// Each stage is a step that is called until it is done, so that a pass can stop between two calls (step_list.hpp).
#pragma once

#include <photongrid/render/scene_map.hpp>
#include <photongrid/render/step_list.hpp>
#include <photongrid/render/view_pass.hpp>

#include <algorithm>
#include <functional>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The steps to a map that only gives the first radii (shrinking_radii.hpp): photons are traced from the lights and
/// sorted or routed into a grid. `m` must outlive the steps.
template <backend B>
step_list radius_map_steps(map_building<B>& m)
{
    step_list steps;
    steps.add("trace_photons", [&m] { return m.trace_photons(); }); // 2.1
    steps.add("build_map", [&m] { return m.build_map(); });         // 2.2
    return steps;
}
/// The left side of figure 1, which runs again only if geometry, materials or lights change: the same, and the
/// irradiance at photons for a final gather.
template <backend B>
step_list map_steps(map_building<B>& m)
{
    auto steps = radius_map_steps(m);
    steps.add("build_map", [&m] { return m.estimate_at_photons(); });
    return steps;
}

/// The right side of figure 1, which runs for every view: traces eye rays, computes direct light and irradiance at
/// their hits, and adds both to the pixels. `v` must outlive the steps.
template <backend B>
step_list view_steps(view_pass<B>& v)
{
    step_list steps;
    const uint done = v.light().rays; // above 0 in a picture that was resumed
    steps.repeat(done, v.rays(), [&v](uint ray) {
        step_list stages;
        stages.add("trace_eye", [&v, ray] { return v.trace_eye(ray); });       // 2.4
        stages.add("direct_light", [&v, ray] { return v.direct_light(ray); }); // 2.4
        stages.add("gather", [&v, ray] { return v.gather(ray); });
        stages.add("irradiance", [&v, ray] { return v.irradiance(ray); }); // 2.3
        stages.add("shade", [&v, ray] { return v.shade(ray); });           // 2.4
        return stages;
    });
    return steps;
}

/// The steps of a pass over its bands of rows, without those above `rows_done`. `begin` is called with a band and
/// returns the steps of its view; `end` is called after them.
inline step_list band_steps(const output_settings& output, std::uint32_t rows_done,
    std::function<step_list(row_band)> begin, std::function<void()> end)
{
    step_list steps;
    const auto bands = bands_of(output);
    const auto first
        = std::find_if(bands.begin(), bands.end(), [&](const row_band& b) { return b.first >= rows_done; });
    steps.repeat(static_cast<uint>(first - bands.begin()), static_cast<uint>(bands.size()),
        [bands, begin = std::move(begin), end = std::move(end)](uint i) {
            step_list of_band;
            of_band.expand([begin, b = bands[i]] { return begin(b); });
            of_band.expand([end] {
                end();
                return step_list();
            });
            return of_band;
        });
    return steps;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
