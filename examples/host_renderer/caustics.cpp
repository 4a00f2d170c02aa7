// All that the host needs for caustics: it traces photons, and photongrid estimates light from them.
#include "caustics.hpp"

#if __has_include(                                                                                                     \
    <photongrid/backends/cpu/cpu.hpp>) // CMakeLists.txt links photongrid::cpu_compiled or photongrid::serial
#include <photongrid/backends/cpu/cpu.hpp>
using device_type = photongrid::cpu_backend;
#else
#include <photongrid/backends/serial/serial.hpp>
using device_type = photongrid::serial_backend;
#endif
#include <photongrid/photon_map.hpp>

namespace host {
struct photon {
    vec3 position, power, direction, normal;
}; // m, W, unit vectors; photongrid reads members of these names

/// The photons that hit only mirrors and glass on their way from the lamp to a diffuse surface.
static std::vector<photon> shoot(const scene& s, int count, std::uint64_t seed)
{
    std::vector<photon> landed;
    for (int i = 0; i < count; ++i) {
        random_stream random(seed, static_cast<std::uint64_t>(i));
        ray r{s.lamp.point(random), cosine_direction(s.lamp.normal(), random)};
        vec3 power = (pi * s.lamp.area() / count) * s.lamp.of.colour;
        for (int bounces = 0; const auto h = s.nearest(r); ++bounces) {
            if (h->of.kind == surface::diffuse && bounces > 0)
                landed.push_back({h->position, power, r.direction, h->normal});
            if (!h->of.is_specular() || bounces == 50)
                break;
            power = power * h->of.colour;
            r = specular_bounce(r, *h, random);
        }
    }
    return landed;
}

irradiance_source caustics_of(const scene& s, int photons, std::uint64_t seed)
{
    device_type device; // not needed for searches for one point once the map is built
    const auto map = std::make_shared<const photongrid::photon_map<device_type>>(device, shoot(s, photons, seed),
        photongrid::knn_settings{.k = 50,
            .max_radius = 0.1f,
            .filter = photongrid::filter_kind::silverman,
            .leaks = {.side = true, .min_cosine = 0.9f}});
    return [map](vec3 position, vec3 normal) -> vec3 {
        thread_local photongrid::query_scratch scratch;
        const auto e = map->irradiance(position, normal, scratch).value;
        return {static_cast<double>(e.r), static_cast<double>(e.g), static_cast<double>(e.b)};
    };
}
} // namespace host
