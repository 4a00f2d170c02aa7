// How much of the discs of estimates lies on the surface, by short rays about their points, for surfaces of every kind:
// a glance at each (glance.glsl), and a closer look at those that may end (probe_disc.glsl).
#pragma once

#include <photongrid/core/zero_vectors.kernel.hpp>
#include <photongrid/estimate/filter.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/render/divide_by_share.kernel.hpp>
#include <photongrid/render/glance.kernel.hpp>
#include <photongrid/render/glance_ray.kernel.hpp>
#include <photongrid/render/marked_points.hpp>
#include <photongrid/render/probe_disc.kernel.hpp>
#include <photongrid/render/probed_point.kernel.hpp>
#include <photongrid/trace/mesh_search.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The discs to probe, and the surfaces that count.
struct disc_probing {
    filter_kind filter;
    float min_cosine; ///< of normals on the same surface: leak_policy::min_cosine
};

/// Discs on surfaces.
template <backend B>
struct probed_discs {
    buffer_of<B, glm::vec4> points; ///< w: squared radius, m^2, of the discs that may have been cut down
    buffer_of<B, glm::vec4> cover;  ///< x: share on the surface, 0 to 1, weighted by the filter; y: 1: it is known
    buffer_of<B, uint> cut; ///< SEARCHED: the disc was cut down or has a half space, else KEPT (pixel_tile.glsl)
    buffer_of<B, glm::vec4> normals; ///< those given; w: knn_settings::half_spaces
};

namespace detail {
    /// Which discs four rays each do not see to be whole: SEARCHED (pixel_tile.glsl).
    template <backend B>
    buffer_of<B, uint> glance_at_discs(B& device, const device_scene<B>& s, const buffer_of<B, glm::vec4>& points,
        const buffer_of<B, glm::vec4>& normals, float min_cosine)
    {
        const auto n = points.size();
        mesh_rays<B> rays(device, n);
        mesh_hits<B> on_meshes(device, s, n);
        auto looked = device.template make<uint>(n);
        for (uint number = 0; number < 4; ++number) {
            device.template run<kernels::glance_ray>(n, {.number = number}, reads(s.records, points, normals, looked),
                writes(rays.origins, rays.directions));
            if (s.has_meshes())
                rays.find_surfaces(device, s, on_meshes);
            device.template run<kernels::glance>({n, 0u, s.layout.features},
                {.number = number, .min_cosine = min_cosine},
                reads(s.records, on_meshes.places, on_meshes.normals, on_meshes.shadings, points, normals, rays.origins,
                    rays.directions),
                writes(looked));
        }
        return looked;
    }

    /// What probe_disc.glsl finds of discs.
    template <backend B>
    buffer_of<B, glm::vec4> probe_closely(B& device, const device_scene<B>& s, const buffer_of<B, glm::vec4>& points,
        const buffer_of<B, glm::vec4>& normals, const disc_probing& how)
    {
        const auto n = points.size();
        mesh_rays<B> rays(device, n);
        mesh_hits<B> on_meshes(device, s, n);
        auto discs = device.template make<glm::vec4>(n), borders = device.template make<glm::vec4>(n),
             firsts = device.template make<glm::vec4>(n), progress = device.template make<glm::vec4>(n);
        for (auto* state : {&rays.origins, &rays.directions, &discs, &borders, &firsts, &progress})
            device.template run<kernels::zero_vectors>(n, {}, reads(), writes(*state));
        for (bool finished = false; !finished;) {
            if (s.has_meshes())
                rays.find_surfaces(device, s, on_meshes);
            finished
                = device
                      .template run_until_done<kernels::probe_disc>({n, 0u, s.layout.features},
                          {.filter_number = static_cast<uint>(how.filter), .min_cosine = how.min_cosine},
                          reads(s.records, on_meshes.places, on_meshes.normals, on_meshes.shadings, points, normals),
                          writes(rays.origins, rays.directions, discs, borders, firsts, progress),
                          s.has_meshes() ? 1u : all_passes)
                      .finished;
        }
        return discs;
    }
} // namespace detail

/// Probes the discs about points (recentred, m; w: squared radius, m^2; 0 or less: none) with unit normals.
/// \throws backend_error.
template <backend B>
probed_discs<B> probe_discs(B& device, const device_scene<B>& s, const buffer_of<B, glm::vec4>& points,
    const buffer_of<B, glm::vec4>& normals, const disc_probing& how)
{
    const auto n = points.size();
    const auto looked = detail::glance_at_discs(device, s, points, normals, how.min_cosine);
    const detail::marked_points<B> few(device, looked);
    auto discs = device.template make<glm::vec4>(1);
    if (few.count > 0) {
        const auto [places, place_normals] = few.gather(device, points, normals);
        discs = detail::probe_closely(device, s, places, place_normals, how);
    }
    probed_discs<B> probed{device.template make<glm::vec4>(n), device.template make<glm::vec4>(n),
        device.template make<uint>(n), device.template make<glm::vec4>(n)};
    device.template run<kernels::probed_point>(n, {}, reads(points, looked, few.words, few.sums, discs, normals),
        writes(probed.points, probed.cover, probed.cut, probed.normals));
    return probed;
}

/// Divides estimates, their standard errors and their biases by the shares of their discs. Smaller shares than a
/// quarter, that of a right corner, count as a quarter: in clutter the rays meet more than there is.
template <backend B>
void divide_by_cover(B& device, const buffer_of<B, glm::vec4>& cover, knn_estimates<B>& estimates)
{
    constexpr float least = 0.25f;
    const auto divide = [&](buffer_of<B, glm::vec4>& values, uint keeps_w) {
        device.template run<kernels::divide_by_share>(
            values.size(), {.least = least, .keeps_w = keeps_w}, reads(cover), writes(values));
    };
    divide(estimates.irradiance, 1);
    divide(estimates.standard_error, 0);
    for (auto* values : estimates.biases.all())
        divide(*values, 0);
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
