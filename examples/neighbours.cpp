// The nearest neighbours of points: the first example of README.md.
#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/point_index.hpp>

#include <cmath>
#include <iostream>

int main()
{
    photongrid::serial_backend device; // or cpu_backend, gl_backend, vulkan_backend
    const std::vector<glm::vec3> points{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
    const std::vector<glm::vec3> queries{{1, 0, 0}, {0, 3, 0}};
    const photongrid::point_index index(device, points);
    const auto nearest = index.nearest(queries, 2);
    for (const auto& n : nearest[0])
        std::cout << "point " << n.id << " at " << std::sqrt(n.distance2) << " m\n";
}
