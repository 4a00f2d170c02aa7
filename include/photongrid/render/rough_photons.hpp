// Photons on rough surfaces. At a rough surface an eye ray samples the lights, and goes on by the surface's density; so
// it finds all light but that of lights without size by smooth surfaces, of which shadow rays are blocked and which no
// ray can hit. Photons find that. Their paths begin at lights without size, have a smooth surface first, and end at the
// first rough one, which stores them. Each is weighed there by the BSDF, so that nothing is counted twice:
//
//     light without size -> smooth ... smooth -> rough     by photons, here
//     light without size -> smooth ... smooth -> matte     by caustic photons
//     light without size -> rough or matte                 by samples of lights
//     light with a size  -> anything                       by samples of lights and by rays, weighed against each other
#pragma once

#include <photongrid/estimate/knn_neighbours.hpp>
#include <photongrid/render/add_light.kernel.hpp>
#include <photongrid/render/is_on_rough.kernel.hpp>
#include <photongrid/render/light_of_photons.kernel.hpp>
#include <photongrid/render/picture_search.hpp>
#include <photongrid/trace/eye_rays.hpp>

#include <algorithm>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The photons on the rough surfaces of a scene.
template <backend B>
struct rough_photons {
    map_buffers<B> map;                         ///< of their places
    buffer_of<B, glm::vec4> powers, directions; ///< by id; rgb: W
};

namespace detail {
    /// Adds their light to the emissions of the eye rays that ended on rough surfaces. `share2`: of squared radii, as
    /// in pass_radii.
    template <backend B>
    void add_light_of_photons(B& device, const device_scene<B>& s, const rough_photons<B>& from,
        const ray_of_pixels& of, double share2, eye_hits<B>& hits)
    {
        const launch all = of.pixels;
        if (from.powers.size() == 0
            || checked_count<kernels::is_on_rough>(device, {all.elements, all.first}, {}, reads(hits.points)) == 0)
            return;
        auto search = search_for_caustics(of.settings);
        search = {.k = std::min(search.k, 64u), .max_radius = search.max_radius};
        constexpr std::size_t most = 65536; // lists need 24 bytes an entry
        for (std::size_t done = 0; done < all.elements; done += most) {
            const launch part(std::min(most, all.elements - done), all.first + static_cast<uint>(done));
            auto points = device.template make<glm::vec4>(part.elements);
            auto surfaces = device.template make<glm::vec4>(part.elements);
            auto light = device.template make<glm::vec4>(part.elements);
            device.template run<kernels::rough_points>({part.elements, 0u, s.layout.features},
                {.first = part.first, .behind = 0},
                reads(s.records, hits.points, hits.directions, hits.throughputs, hits.surfaces, hits.emissions),
                writes(points, surfaces));
            const auto lists = knn_neighbours(device, from.map, points, search);
            device.template run<kernels::light_of_photons>({part.elements, 0u, s.layout.features},
                {.first = part.first,
                    .k = search.k,
                    .share2 = static_cast<float>(share2),
                    .max_radius2 = search.max_radius * search.max_radius},
                reads(s.records, hits.points, hits.directions, hits.throughputs, hits.surfaces, hits.emissions,
                    lists.ids, lists.distances2, from.powers, from.directions),
                writes(light));
            device.template run<kernels::add_light>(part, {.first = part.first}, reads(light), writes(hits.emissions));
        }
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
