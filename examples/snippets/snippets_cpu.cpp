// The manual's snippets of the cpu backend, run and checked.
#include "expect.hpp"

#include <photongrid/backends/cpu/cpu.hpp>
#include <photongrid/map/bitonic_sort.hpp>

#include <iostream>

int main()
try {
    //! [cpu_backend]
    // It sorts, builds maps and searches by SIMD.
    photongrid::cpu_backend device(2); // threads; 0: as many as the machine has
    auto pairs = photongrid::upload(device, std::vector<glm::uvec2>{{30, 0}, {10, 1}, {20, 2}, {10, 3}});
    photongrid::bitonic_sort(device, pairs); // (10, 1) (10, 3) (20, 2) (30, 0)
    //! [cpu_backend]
    expect(device.download(pairs) == std::vector<glm::uvec2>{{10, 1}, {10, 3}, {20, 2}, {30, 0}}, "cpu_backend");
} catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
}
