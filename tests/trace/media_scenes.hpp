// Scenes of glass in glass, for tests.
#pragma once

#include <photongrid/scene/scene.hpp>

namespace photongrid::testing {

inline material clear_glass(const char* name, double index, double priority = 1)
{
    material m{name, material_kind::glass, dvec3(1), index};
    m.priority = priority;
    return m;
}

/// Four squares of different colours under a bulb, behind where bodies of glass are to stand, about the origin.
inline scene before_coloured_squares()
{
    scene s;
    s.name = "squares";
    const dvec3 colours[] = {{0.9, 0.1, 0.1}, {0.1, 0.9, 0.1}, {0.1, 0.1, 0.9}, {0.9, 0.9, 0.9}};
    for (std::uint32_t i = 0; i < 4; ++i) {
        s.materials.push_back({"colour " + std::to_string(i), material_kind::lambertian, colours[i]});
        const double x = i % 2 == 0 ? -4 : 0, y = i < 2 ? -4 : 0;
        s.polygons.push_back({{{x, y, -2}, {x + 4, y, -2}, {x + 4, y + 4, -2}, {x, y + 4, -2}}, i});
    }
    s.point_lights = {{"bulb", {0, 0, -1.2}, dvec3(30)}};
    s.camera = {{0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 25};
    s.render.map.photons = 4000;
    s.render.estimate.k = 50;
    s.render.output.width = s.render.output.height = 12;
    s.render.view.spp = 256; // of many branches, as noise
    s.render.view.depth = 16;
    return s;
}

/// In the light of a white sky.
inline scene in_a_white_sky()
{
    scene s;
    s.name = "sky";
    s.environment_lights = {{.name = "sky", .file = "", .map = nullptr, .radiance = dvec3(1)}};
    s.camera = {{0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 25};
    s.render.output.width = s.render.output.height = 16;
    s.render.view.spp = 1;
    return s;
}

/// A ball of absorbing water in one of glass, with ice that reaches out of the water, above a floor.
inline scene iced_water()
{
    scene s;
    s.name = "iced water";
    s.materials = {{"floor", material_kind::lambertian, dvec3(0.7)}, clear_glass("water", 1.33, 1),
        clear_glass("shell", 1.5, 0.5), clear_glass("ice", 1.31, 3)};
    s.materials[1].absorption = {2, 0.5, 0.1};
    s.polygons = {{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, 0}};
    s.spheres = {{{0, 0.5, 0}, 0.45, 2}, {{0.05, 0.5, 0}, 0.32, 1}, {{0.2, 0.65, 0.1}, 0.14, 3}};
    s.rectangle_lights = {{"lamp", {-0.4, 1.6, -0.4}, {0.8, 0, 0}, {0, 0, 0.8}, dvec3(20)}};
    s.camera = {{0.3, 1.1, -2.4}, {0, 0.4, 0}, {0, 1, 0}, 32};
    s.render.map.photons = 20000;
    s.render.estimate.k = 100;
    s.render.estimate.max_radius = 0.3;
    s.render.output.width = s.render.output.height = 24;
    s.render.view.depth = 16;
    return s;
}

} // namespace photongrid::testing
