// A user's program: the nearest photons of a point, from the installed headers.
#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/build_map.hpp>
#include <photongrid/knn_grid_estimate.hpp>

#include <cstdio>

#ifdef PARAMS
#error "a word of the kernel dialect reached user code"
#endif

int main()
{
    photongrid::serial_backend device;
    std::vector<glm::vec4> positions, powers;
    for (int i = 0; i < 1000; ++i) {
        positions.emplace_back(float(i % 10) * 0.1f, float(i / 10 % 10) * 0.1f, float(i / 100) * 0.1f, 0.0f);
        powers.emplace_back(1.0f, 1.0f, 1.0f, 0.0f);
    }
    photongrid::photons<photongrid::serial_backend> photons{device.upload(std::span<const glm::vec4>(positions)), device.upload(std::span<const glm::vec4>(powers)), {}};
    const auto grid = photongrid::make_grid(glm::vec3(0), glm::vec3(1), {10, 10, 10});
    const auto map = photongrid::sorted_map(device, std::move(photons), grid);
    const std::vector<glm::vec4> points{{0.45f, 0.45f, 0.45f, 1.0f}};
    const auto estimates = photongrid::knn_grid_estimate(device, map, device.upload(std::span<const glm::vec4>(points)), {.k = 8, .max_radius = 1.0f});
    const auto used = device.download(estimates.used)[0].x;
    std::printf("%u photons\n", used);
    return used >= 8 ? 0 : 1;
}
