// The shortest way to the compiled cpu backend: a photon map and an index of points, whose members its library holds.
#include <photongrid/backends/cpu/compiled.hpp>

#include "nearest.hpp"

int main()
{
    photongrid::cpu_backend device;
    const auto all = consumer::photons();
    const photongrid::photon_map map(device, all, {.k = consumer::k, .max_radius = 1.0f});
    const auto e = map.irradiance(std::vector<glm::vec4>{consumer::point})[0];
    const bool is_right = consumer::is_right(glm::vec4(e.value, e.radius * e.radius));

    std::vector<glm::vec3> points;
    for (const auto& p : all)
        points.push_back(p.position);
    const photongrid::point_index index(device, points);
    const auto nearest = index.nearest(std::vector<glm::vec3>{points[7]}, 1);
    return is_right && nearest[0][0].id == photongrid::photon_id{7} ? 0 : 1;
}
