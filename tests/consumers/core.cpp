// A user of the core headers alone, without a backend: the radiance of a white floor under a point light.
#include <photongrid/reference/reference.hpp>
#include <photongrid/render/render.hpp> // for its warnings
#include <photongrid/version.hpp>

#include <cmath>
#include <cstdio>
#include <string>

int main()
{
    // EXPECTED_VERSION is the version that find_package() found.
    const auto version = std::to_string(PHOTONGRID_VERSION_MAJOR) + '.' + std::to_string(PHOTONGRID_VERSION_MINOR) + '.'
        + std::to_string(PHOTONGRID_VERSION_PATCH);
    if (version != EXPECTED_VERSION
        || photongrid::library_version
            != PHOTONGRID_VERSION_MAJOR * 10000 + PHOTONGRID_VERSION_MINOR * 100 + PHOTONGRID_VERSION_PATCH) {
        std::printf("the headers' version is %s, the package's %s\n", version.c_str(), EXPECTED_VERSION);
        return 1;
    }

    photongrid::scene floor;
    floor.materials.push_back({.name = "white", .reflectance = glm::dvec3(1)});
    floor.disks.push_back({.center = {0, 0, 0}, .normal = {0, 1, 0}, .radius = 0.01});
    floor.point_lights.push_back({.name = "lamp", .position = {0, 2, 0}, .power = glm::dvec3(10)});
    const photongrid::camera view{.position = {0, 1, 1}, .look_at = {0, 0, 0}, .vertical_fov = 0.1};
    const auto picture = photongrid::render_reference(floor, view, {.width = 1, .height = 1, .spp = 16, .threads = 1});
    const double pi = 3.14159265,
                 expected = 10 / (4 * pi) / (2 * 2) / pi; // intensity / distance^2, reflected every way alike
    const double radiance = static_cast<double>(picture.mean.pixels[0].x);
    std::printf("radiance %g W/(m^2 sr), expected %g\n", radiance, expected);
    return std::abs(radiance - expected) < 1e-4 * expected ? 0 : 1;
}
