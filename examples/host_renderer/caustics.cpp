// All that the host needs for caustics: photons of its own, and photongrid to make light of them.
#include "caustics.hpp"

#if __has_include(<photongrid/backends/cpu/cpu.hpp>) // CMakeLists.txt links photongrid::cpu, or without it photongrid::serial
#include <photongrid/backends/cpu/overrides/all.hpp>
using device_type = photongrid::cpu_backend;
#else
#include <photongrid/backends/serial/serial.hpp>
using device_type = photongrid::serial_backend;
#endif
#include <photongrid/build_map.hpp>
#include <photongrid/fitting_grid.hpp>
#include <photongrid/knn_grid_estimate.hpp>
#include <photongrid/own_photons.hpp>

namespace host {
struct photon { vec3 position, flux, direction, normal; }; // m, W, unit vectors; photongrid reads members of these names

/// The photons that meet only mirrors and glass on their way from the lamp to a diffuse surface.
static std::vector<photon> shoot(const scene& s, int count, std::uint64_t seed)
{
    std::vector<photon> landed;
    for (int i = 0; i < count; ++i) {
        random_stream random(seed, static_cast<std::uint64_t>(i));
        ray r{s.lamp.point(random), cosine_direction(s.lamp.normal(), random)};
        vec3 flux = (pi * s.lamp.area() / count) * s.lamp.of.colour;
        for (int bounces = 0; const auto h = s.nearest(r); ++bounces) {
            if (h->of.kind == surface::diffuse && bounces > 0)
                landed.push_back({h->where, flux, r.along, h->normal});
            if (!h->of.is_specular() || bounces == 50)
                break;
            flux = flux * h->of.colour;
            r = specular_bounce(r, *h, random);
        }
    }
    return landed;
}

irradiance_source caustics_of(const scene& s, int photons, std::uint64_t seed)
{
    const auto device = std::make_shared<device_type>();
    const photongrid::knn_settings how{.k = 50, .max_radius = 0.1f, .kernel = photongrid::filter_kernel::silverman, .leaks = {.side = true, .min_cosine = 0.9f}};
    auto uploaded = photongrid::upload_photons(*device, shoot(s, photons, seed));
    const auto grid = photongrid::fitting_grid(*device, uploaded, how.k, device->caps().cells_a_radius);
    const auto map = std::make_shared<const photongrid::photon_map<device_type>>(photongrid::sorted_map(*device, std::move(uploaded), grid));
    return [=](const std::vector<gather_point>& points) {
        std::vector<glm::vec4> at, normals;
        for (const auto& p : points) {
            at.emplace_back(p.where.x, p.where.y, p.where.z, 1); // 1: wanted
            normals.emplace_back(p.normal.x, p.normal.y, p.normal.z, 0);
        }
        const auto found = photongrid::knn_grid_estimate(*device, *map, device->upload(std::span(std::as_const(at))), device->upload(std::span(std::as_const(normals))), how);
        std::vector<vec3> irradiance;
        for (const auto& e : device->download(found.irradiance))
            irradiance.push_back({e.x, e.y, e.z});
        return irradiance;
    };
}
} // namespace host
