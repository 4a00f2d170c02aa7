// A user's program on any backend: a photon map of the user's own photons, and an estimate of the light at a point.
#pragma once

#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/map_builders.hpp>
#include <photongrid/map/own_photons.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace consumer {

struct photon {
    glm::vec3 position; // m
    float power;        // W
};

/// Photons spread over the unit cube by multiples of irrational numbers.
inline std::vector<photon> photons()
{
    std::vector<photon> all;
    for (int i = 1; i <= 1000; ++i) {
        const auto part = [i](double irrational) { return static_cast<float>(std::fmod(i * irrational, 1.0)); };
        all.push_back({{part(0.8191725), part(0.6710436), part(0.5497005)}, 0.5f});
    }
    return all;
}

inline constexpr glm::vec4 point{0.45f, 0.55f, 0.4f, 1.0f};
inline constexpr photongrid::uint k = 8;

template <photongrid::backend B>
photongrid::map_buffers<B> make_map(B& device)
{
    return photongrid::sorted_map(device, photongrid::upload_photons(device, photons()),
        photongrid::make_grid(glm::vec3(0), glm::vec3(1), {10, 10, 10}));
}

/// Irradiance at the point from the k nearest photons, W/m^2; w: squared distance of the k-th, m^2.
template <photongrid::backend B>
glm::vec4 estimate(B& device, const photongrid::map_buffers<B>& map)
{
    const auto points = device.upload(std::span(&point, 1));
    return device.download(
        photongrid::knn_grid_estimate(device, map, points, {.k = k, .max_radius = 1.0f}).irradiance)[0];
}

/// Does the estimate equal what looking at every photon gives? The k-th photon sets the radius and does not count.
inline bool is_right(glm::vec4 estimate)
{
    std::vector<float> squared;
    for (const auto& p : photons()) {
        const auto d = p.position - glm::vec3(point);
        squared.push_back(d.x * d.x + d.y * d.y + d.z * d.z);
    }
    std::ranges::nth_element(squared, squared.begin() + (k - 1));
    const double radius2 = static_cast<double>(squared[k - 1]), irradiance = (k - 1) * 0.5 / (3.14159265 * radius2);
    std::printf("irradiance %g W/m^2, by brute force %g\n", static_cast<double>(estimate.x), irradiance);
    return std::abs(static_cast<double>(estimate.w) - radius2) < 1e-6 * radius2
        && std::abs(static_cast<double>(estimate.x) - irradiance) < 1e-5 * irradiance;
}

/// For main(): 0 if the device finds the right photons.
template <photongrid::backend B>
int nearest(B& device)
{
    return is_right(estimate(device, make_map(device))) ? 0 : 1;
}

} // namespace consumer
