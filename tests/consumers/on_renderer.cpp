// The renderer on a backend that is chosen at run time; no header of a backend is read.
#include <photongrid/backends/any/any.hpp>

#include <iostream>
#include <stdexcept>

namespace {

photongrid::scene ball_on_a_floor()
{
    photongrid::scene s;
    s.materials = {{"white", photongrid::material_kind::lambertian, photongrid::dvec3(0.7)}};
    s.polygons = {{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, 0}};
    s.spheres = {{{0.2, 0.3, 0}, 0.3, 0}}; // light comes to the floor by way of it
    s.point_lights = {{"lamp", {0, 1, 0.5}, photongrid::dvec3(10)}};
    s.camera = {{0, 1, 1}, {0, 0, 0}, {0, 1, 0}, 40};
    s.render.map.photons = 500;
    s.render.estimate.k = 20;
    s.render.output.width = s.render.output.height = 16;
    return s;
}

} // namespace

int main()
{
    int failures = 0;
    const auto scene = ball_on_a_floor();
    for (const auto& d : photongrid::find_devices())
        std::cout << d.backend << ": " << (d.works ? d.device : d.description) << '\n';
    photongrid::image first;
    for (const auto* backend : {"serial", "auto"}) {
        const auto device = photongrid::make_renderer({.backend = backend});
        const auto [picture, stats] = photongrid::render(*device, scene);
        if (stats.photons.stored != 500 || picture.pixels.size() != 256 || !(picture.pixels[136].x > 0))
            ++failures;
        std::cout << backend << ": " << device->caps().backend << ", " << picture.pixels[136].x << '\n';
    }
    try {
        photongrid::make_renderer({.backend = "metal"});
        ++failures;
    } catch (const std::invalid_argument& e) {
        std::cout << e.what() << '\n';
    }
    return failures;
}
