// How long each backend takes to sort, index and route photons, and what device memory that takes: docs/measures.md.
#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/build_map.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>

namespace {

using namespace photongrid;

/// Median of five runs of `f`, ms; the device is waited for.
template <class B, class F>
double median_ms(B& b, F&& f)
{
    std::vector<double> times;
    f(); // kernels compile here
    for (int i = 0; i < 5; ++i) {
        b.finish();
        const auto start = std::chrono::steady_clock::now();
        f();
        b.finish();
        times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    std::sort(times.begin(), times.end());
    return times[2];
}

template <backend B>
void measure(B&& b, uint n)
{
    std::mt19937 engine(1);
    std::vector<glm::vec4> positions(n), powers(n, glm::vec4(1));
    for (auto& p : positions)
        for (int a = 0; a < 3; ++a)
            p[a] = static_cast<float>(engine() >> 8) * 0x1p-24f;
    const auto g = make_grid(glm::vec3(0), glm::vec3(1), {25, 25, 50});
    const photons<std::remove_reference_t<B>> p{b.upload(std::span<const glm::vec4>(positions)), b.upload(std::span<const glm::vec4>(powers)), {}};
    auto keys = b.template make<glm::uvec2>(n);
    const auto make_keys = [&] { b.template run<kernels::photon_cell>(n, {.grid = g, .photons = n, .parts = every_part}, reads(p.positions, p.powers), writes(keys)); };
    sort_report report;
    const double sort = median_ms(b, [&] {
        make_keys();
        report = bitonic_sort(b, keys);
    });
    const double index = median_ms(b, [&] { grid_index(b, keys, cell_count(g)); });
    const double route = median_ms(b, [&] { stencil_route(b, p, g, 4); });
    std::printf("| %s | %u | %u | %.1f | %.2f | %.1f | %.1f |\n", b.caps().backend.c_str(), n, report.passes, sort, index, route, static_cast<double>(b.peak_bytes()) / n);
}

} // namespace

int main()
{
    std::printf("| backend | photons | sort passes | keys and sort ms | index ms | route ms (m = 4) | peak device bytes a photon |\n|---|---|---|---|---|---|---|\n");
    for (const uint n : {65536u, 1048576u}) {
        measure(serial_backend(), n);
        measure(gl_backend(gl_options{}), n);
        measure(vulkan_backend(vulkan_options{}), n);
    }
}
