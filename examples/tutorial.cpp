// docs/tutorial.md, whole: photons of one's own, and how bright they make a floor.
#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/build_map.hpp>
#include <photongrid/knn_grid_estimate.hpp>
#include <photongrid/knn_neighbours.hpp>
#include <photongrid/own_photons.hpp>

#include <cstdio>
#include <random>

// A photon as your renderer has it: your vectors, your names. photongrid looks for `position` and `flux`.
struct my_vector {
    double x, y, z;
};
struct my_photon {
    my_vector position; // m
    my_vector flux;     // W, red, green, blue
};

int main()
{
    // 100,000 photons of a lamp that sends 12 W to a floor of 2 m by 2 m, evenly: 3 W/m^2 in each channel.
    std::mt19937 random(2003);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<my_photon> photons;
    for (int i = 0; i < 100000; ++i)
        photons.push_back({{2 * unit(random), 2 * unit(random), 0}, {12e-5, 12e-5, 12e-5}});

    photongrid::serial_backend device; // cpu_backend, gl_backend, vulkan_backend: nothing else changes
    const auto map = photongrid::fitted_map(device, photongrid::upload_photons(device, photons), 400);

    const std::vector<my_vector> places{{1, 1, 0}, {0.5, 1.4, 0}};
    const auto points = photongrid::upload_points(device, places);
    const auto estimates = photongrid::knn_grid_estimate(device, map, points, {.k = 400, .errors = true});

    const auto irradiance = device.download(estimates.irradiance);
    const auto error = device.download(estimates.standard_error);
    for (std::size_t i = 0; i < places.size(); ++i)
        std::printf("%.2f +- %.2f W/m^2 within %.0f mm\n", static_cast<double>(irradiance[i].x),
            static_cast<double>(error[i].x), 1000 * std::sqrt(static_cast<double>(irradiance[i].w)));

    const auto nearest = photongrid::knn_neighbours(device, map, points, {.k = 3});
    const auto ids = device.download(nearest.ids);
    std::printf("nearest to the middle: photons %u, %u, %u\n", ids[0], ids[1], ids[2]);
}
