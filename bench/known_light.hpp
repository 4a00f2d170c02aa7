// Exact passes (as_exact) of one eye ray, shadow ray and path per pixel, and scenes drawn by them whose light is known.
#pragma once

#include <photongrid/render/image.hpp>
#include <photongrid/scene/scene.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace photongrid {

/// Exact passes that cost the least each.
inline render_settings cheap_exact(render_settings s)
{
    s = as_exact(s);
    s.view.spp = s.view.light_samples = s.estimate.gather_rays = 1;
    return s;
}

struct known_scene {
    scene s;
    image light; ///< its picture, W/(m^2 sr)
};

/// A picture of known light over a plane y = 0, seen straight from above: means over pixels by quadrature.
template <class Radiance>
image light_from_above(const scene& s, const Radiance& radiance)
{
    const auto& o = s.render.output;
    image light{o.width, o.height, std::vector<glm::vec3>(std::size_t{o.width} * o.height)};
    const double pixel = 2 * s.camera.position.y * std::tan(s.camera.vertical_fov * std::numbers::pi / 360) / o.height;
    const dvec3 right = glm::normalize(glm::cross(s.camera.look_at - s.camera.position, s.camera.up));
    constexpr int steps = 8;
    for (std::uint32_t y = 0; y < o.height; ++y)
        for (std::uint32_t x = 0; x < o.width; ++x) {
            double sum = 0;
            for (int i = 0; i < steps * steps; ++i) {
                const double across = x + (i % steps + 0.5) / steps - 0.5 * o.width,
                             down = y + std::floor(i / steps) / steps + 0.5 / steps - 0.5 * o.height;
                sum += radiance(s.camera.look_at + pixel * (across * right - down * s.camera.up));
            }
            light.pixels[std::size_t{y} * o.width + x] = glm::vec3(static_cast<float>(sum / (steps * steps)));
        }
    return light;
}

/// A floor seen straight from above, before a wall in the plane x = 1.
inline scene floor_before_a_wall(const char* name)
{
    scene s;
    s.name = name;
    s.materials = {{"white", material_kind::lambertian, dvec3(0.5)}, {"wall", material_kind::mirror, dvec3(1)}};
    s.polygons
        = {{{{-3, 0, -3}, {-3, 0, 3}, {1, 0, 3}, {1, 0, -3}}, 0}, {{{1, 0, -3}, {1, 0, 3}, {1, 3, 3}, {1, 3, -3}}, 1}};
    s.camera = {{0.3, 2, 0}, {0.3, 0, 0}, {0, 0, 1}, 30};
    s.render = {.map = {.photons = 1000, .builder = map_builder::automatic, .grid = glm::uvec3(0)},
        .estimate = {.k = 20, .max_radius = 2},
        .output = {.width = 16, .height = 16}};
    return s;
}

/// A mirror shows the floor a second bulb, behind it: its light is a caustic, the only light that is drawn.
inline known_scene second_bulb_in_a_mirror()
{
    auto s = floor_before_a_wall("a second bulb in a mirror");
    s.point_lights = {{"bulb", {0.4, 0.5, 0}, dvec3(4 * std::numbers::pi)}};
    s.render = cheap_exact(s.render);
    s.render.output.only = light_part::caustic;
    return {s, light_from_above(s, [](const dvec3& p) {
                const dvec3 to = dvec3(1.6, 0.5, 0) - p;
                return 0.5 / std::numbers::pi * to.y / std::pow(glm::length(to), 3);
            })};
}

/// A dark floor before a diffuse wall that the sun lights: its indirect light alone is drawn.
inline known_scene floor_before_a_sunlit_wall()
{
    auto s = floor_before_a_wall("a floor before a sunlit wall");
    s.materials[0].reflectance = dvec3(1e-4); // else the wall would have light from the floor
    s.materials[1] = {"wall", material_kind::lambertian, dvec3(0.8)};
    s.directional_lights = {{"sun", {1, 0, 0}, dvec3(3e5)}};
    s.render = cheap_exact(s.render);
    s.render.output.only = light_part::indirect;
    // The form factor of a rectangle that stands on the floor's plane, for a point of the floor (Lambert's formula).
    return {s, light_from_above(s, [](const dvec3& p) {
                const double x = 1 - p.x, top = std::hypot(x, 3.0), a = 3 - p.z, b = 3 + p.z;
                const double factor
                    = (std::atan(a / x) + std::atan(b / x) - x / top * (std::atan(a / top) + std::atan(b / top)))
                    / (2 * std::numbers::pi);
                return 1e-4 / std::numbers::pi * factor * 0.8 * 3e5;
            })};
}

} // namespace photongrid
