// The library without the renderer: sort (key, value) pairs on a backend. Change the device's line to sort on a GPU.
#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/map/bitonic_sort.hpp>

#include <iostream>

int main()
{
    photongrid::serial_backend device;
    const std::vector<glm::uvec2> pairs{{30, 0}, {10, 1}, {20, 2}, {10, 3}};
    auto buffer = device.upload(std::span(pairs));
    const auto report = photongrid::bitonic_sort(device, buffer);
    for (const auto& pair : device.download(buffer))
        std::cout << pair.x << " -> " << pair.y << '\n'; // 10 -> 1, 10 -> 3, 20 -> 2, 30 -> 0
    std::cout << report.passes << " passes\n";
}
