// The whole program of docs/guide/tutorial.md: your own photons, and the irradiance that they give on a floor.
#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/photon_map.hpp>

#include <cstdio>
#include <random>

// A photon of your renderer: your vectors, your names. photongrid reads `position` and `power`.
struct my_vector {
    double x, y, z;
};
struct my_photon {
    my_vector position; // m
    my_vector power;    // W, red, green, blue
};

int main()
{
    // 100,000 photons of a lamp that gives 12 W uniformly to a floor of 2 m by 2 m: 3 W/m^2 in each channel.
    std::mt19937 random(2003);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<my_photon> photons;
    photons.reserve(100000);
    for (int i = 0; i < 100000; ++i)
        photons.push_back({{2 * unit(random), 2 * unit(random), 0}, {12e-5, 12e-5, 12e-5}});

    photongrid::serial_backend device; // or cpu_backend, gl_backend, vulkan_backend, with its header and CMake target
    const photongrid::photon_map map(device, photons, {.k = 400});

    const std::vector<my_vector> points{{1, 1, 0}, {0.5, 1.4, 0}};
    for (const auto& e : map.irradiance(points, {.standard_error = true}))
        std::printf("%.2f +- %.2f W/m^2 within %.0f mm\n", static_cast<double>(e.value.r),
            static_cast<double>(e.error.r), 1000 * static_cast<double>(e.radius));

    std::printf("nearest to the middle: photons");
    map.for_each_nearest(points[0], 3, [](photongrid::photon_id id, float) { std::printf(" %u", id); });
    std::printf("\n");
}
