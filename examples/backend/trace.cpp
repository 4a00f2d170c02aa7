// The calls that a photon map and estimates from it make to a backend: a table of verbs and kernels.
#include "tracing_backend.hpp"

#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/map_builders.hpp>

#include <iostream>

namespace {

using namespace photongrid;

template <backend B>
void trace_on(B& device)
{
    examples::tracing_backend<B&> traced(device);
    traced.wait_for_each_verb(true);
    // 4,096 photons on a lattice, and points between them.
    std::vector<glm::vec4> positions, powers, points;
    for (uint i = 0; i < 4096; ++i) {
        const glm::vec3 place(i % 16, i / 16 % 16, i / 256);
        positions.emplace_back(place / 16.0f, 0.0f);
        powers.emplace_back(1.0f, 1.0f, 1.0f, 0.0f);
        if (i % 8 == 0)
            points.emplace_back((place + 0.5f) / 16.0f, 1.0f);
    }
    photons<examples::tracing_backend<B&>> all{
        traced.upload(std::span<const glm::vec4>(positions)), traced.upload(std::span<const glm::vec4>(powers)), {}};
    const auto map = sorted_map(traced, std::move(all), make_grid(glm::vec3(0), glm::vec3(1), {8, 8, 8}));
    const auto estimates
        = knn_grid_estimate(traced, map, traced.upload(std::span<const glm::vec4>(points)), {.k = 8, .max_radius = 1});
    std::cout << device.caps().backend << ", " << device.caps().device << ": "
              << traced.download(estimates.irradiance).size() << " estimates\n";
    traced.print(std::cout);
}

} // namespace

int main()
{
    serial_backend serial;
    trace_on(serial);
}
