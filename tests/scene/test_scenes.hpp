// Scenes whose light is known, and the Cornell box cut down, built in C++.
#pragma once

#include <photongrid/scene/scene.hpp>

namespace photongrid::testing {

/// A point light of 4 pi^2 W at the middle of a diffuse sphere of radius 1, seen from inside: an integrating sphere.
/// Direct irradiance is pi W/m^2 everywhere, all irradiance pi / (1 - reflectance), radiance reflectance / (1 -
/// reflectance).
inline scene integrating_sphere(dvec3 reflectance)
{
    scene s;
    s.name = "integrating_sphere";
    s.materials = {{"wall", material_kind::lambertian, reflectance}};
    s.spheres = {{dvec3(0), 1.0, 0}};
    s.point_lights = {{"middle", dvec3(0), dvec3(4 * M_PI * M_PI)}};
    s.camera = {{0.1, 0.2, 0.3}, {1, 0, 0}, {0, 1, 0}, 80};
    s.render = {.map = {.photons = 40000, .grid = {12, 12, 12}},
        .estimate = {.k = 200, .max_radius = 0.5},
        .output = {.width = 32, .height = 24}};
    return s;
}

/// A box, open towards the camera, with a ball of glass and one of metal, lit from the ceiling.
inline scene small_cornell()
{
    scene s;
    s.name = "small_cornell";
    s.materials = {{"white", material_kind::lambertian, dvec3(0.74)},
        {"red", material_kind::lambertian, {0.47, 0.05, 0.05}}, {"green", material_kind::lambertian, {0.09, 0.4, 0.08}},
        {"mirror", material_kind::metal, {0.9, 0.8, 0.7}}, {"glass", material_kind::glass, dvec3(1), 1.5}};
    const auto wall = [&](dvec3 a, dvec3 b, dvec3 c, dvec3 d, std::uint32_t m) {
        s.polygons.push_back({{a, b, c, d}, m});
    };
    wall({0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, 0); // floor
    wall({0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0}, 0); // ceiling
    wall({0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, 0); // back
    wall({0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0}, 1);
    wall({1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}, 2);
    s.spheres = {{{0.7, 0.2, 0.65}, 0.2, 3}, {{0.3, 0.18, 0.35}, 0.18, 4}};
    s.rectangle_lights = {{"lamp", {0.35, 0.999, 0.4}, {0.3, 0, 0}, {0, 0, 0.25}, dvec3(4, 3.5, 3)}};
    s.camera = {{0.5, 0.5, -1.4}, {0.5, 0.5, 0}, {0, 1, 0}, 39};
    s.render = {.map = {.photons = 8000, .grid = {12, 12, 12}},
        .estimate = {.k = 80, .max_radius = 0.25},
        .view = {.spp = 1, .light_samples = 4},
        .output = {.width = 64, .height = 64}};
    return s;
}

/// A convex polygon as a mesh: a fan of triangles.
inline placed_mesh mesh_of(const polygon& p)
{
    mesh fan;
    for (const auto& v : p.vertices)
        fan.positions.emplace_back(v);
    for (uint i = 2; i < p.vertices.size(); ++i)
        fan.triangles.push_back({0, i - 1, i});
    return {"", std::make_shared<const mesh>(std::move(fan)), glm::dmat3(1), dvec3(0), p.material};
}

/// The scene with a mesh for each of its polygons.
inline scene with_meshes(scene s)
{
    for (const auto& p : s.polygons)
        s.meshes.push_back(mesh_of(p));
    s.polygons.clear();
    return s;
}

/// Every shape there is, in one scene, under a point light and a lamp.
inline scene all_shapes()
{
    scene s;
    s.name = "all_shapes";
    s.materials = {{"white", material_kind::lambertian, dvec3(0.7)}, {"gold", material_kind::metal, {0.9, 0.7, 0.3}},
        {"glass", material_kind::glass, dvec3(0.98), 1.5}, {"mirror", material_kind::mirror, dvec3(0.95)}};
    s.polygons
        = {{{{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}}, 0}, {{{-1, 0.1, 1}, {0, 1.2, 1.2}, {1, 0.1, 1}}, 0},
            {{{-1.8, 0, 0.2}, {-1.8, 0, 0.8}, {-1.8, 0.5, 1.0}, {-1.8, 0.9, 0.5}, {-1.8, 0.5, 0.0}}, 0}};
    s.spheres = {{{0, 0.3, 0}, 0.3, 2}, {{1.2, 0.25, 0.3}, 0.25, 0}};
    s.cylinders = {{{-0.8, 0, -0.4}, {-0.8, 0.3, -0.4}, 0.35, 1}, {{0.5, 0.2, -0.9}, {0.9, 0.4, -0.7}, 0.1, 0}};
    s.cones = {{{0.8, 0, -0.2}, {0.8, 0.6, -0.2}, 0.25, 0}};
    s.paraboloids = {{{-0.3, 0.02, -1.0}, {-0.3, 0.3, -1.1}, 0.3, 3}};
    s.boxes = {{{-1.5, 0, -1.4}, {0.4, 0, 0.2}, {0, 0.3, 0}, {-0.2, 0, 0.4}, 0}};
    s.disks = {{{0.2, 0.8, 0.9}, {0, -0.5, -1}, 0.4, 3}};
    s.point_lights = {{"bulb", {1.0, 1.8, -1.2}, dvec3(20, 18, 15)}};
    s.rectangle_lights = {{"lamp", {-0.4, 2.0, -0.4}, {0.8, 0, 0}, {0, 0, 0.8}, dvec3(10, 11, 12)}};
    s.camera = {{0, 1.4, -3.2}, {0, 0.3, 0}, {0, 1, 0}, 45};
    s.render = {.map = {.photons = 6000, .grid = {30, 10, 30}},
        .estimate = {.k = 40, .max_radius = 0.3},
        .view = {.spp = 1, .light_samples = 4},
        .output = {.width = 96, .height = 64}};
    return s;
}

/// The same with meshes: a glass one with normals, a white one that is mirrored, a metal one and a lamp that share its
/// surface.
inline scene all_shapes_and_meshes()
{
    auto s = all_shapes();
    s.name = "all_shapes_and_meshes";
    // A tetrahedron, seen from outside counterclockwise.
    const auto surface = std::make_shared<const mesh>(
        mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
    auto smooth = *surface;
    smooth.normals = {{-1, -1, -1}, {1, 0, 0}, {0, 2, 0.5f}, {0, 0, 1}};
    s.meshes = {{"", std::make_shared<const mesh>(smooth), glm::dmat3(0.5), {0.7, 0.05, 0.9}, 2},
        {"", surface, glm::dmat3(-0.4, 0, 0, 0, 0.5, 0, 0, 0, 0.4), {-0.5, 0.01, 1.2}, 0},
        {"", surface, glm::dmat3(0.3, 0, 0.1, 0, 0.6, 0, -0.1, 0, 0.3), {-1.6, 0.02, 1.2}, 1}};
    s.mesh_lights
        = {{"ember", {"", surface, glm::dmat3(0.2, 0, 0, 0, -0.3, 0, 0, 0, 0.1), {1.5, 1.2, 1}, 0}, {5, 3, 1}}};
    return s;
}

/// A picture of 24 x 12 directions, with a sun, a bright texel at each pole, and black ones.
inline std::shared_ptr<const environment_map> sky_with_a_sun()
{
    environment_map m{24, 12, {}};
    for (std::uint32_t row = 0; row < m.height; ++row)
        for (std::uint32_t column = 0; column < m.width; ++column) {
            const auto x = static_cast<float>(column) / 24, y = static_cast<float>(row) / 12;
            m.radiance.emplace_back(0.2f + 0.5f * x, 0.4f * y, row == 9 ? 0.0f : 0.3f);
            if (column % 7 == 3)
                m.radiance.back() = glm::vec3(0);
        }
    m.radiance[3 * 24 + 17] = {60, 50, 40};
    m.radiance[5] = {3, 1, 1};
    m.radiance[11 * 24 + 8] = {1, 1, 4};
    return std::make_shared<const environment_map>(m);
}

/// A white floor of 6 m x 6 m without lights, and what a picture of its middle needs.
inline scene bare_floor()
{
    scene s;
    s.name = "floor";
    s.materials = {{"white", material_kind::lambertian, dvec3(0.8)}, {"pane", material_kind::glass, dvec3(1), 1}};
    s.polygons = {{{{-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}}, 0}};
    s.camera = {{0.1, 4.5, 0}, {0, 0, 0}, {0, 0, 1}, 50};
    s.render = {.map = {.photons = 60000, .grid = {60, 1, 60}},
        .estimate = {.k = 200, .max_radius = 0.2},
        .view = {.light_samples = 64},
        .output = {.width = 16, .height = 16}};
    return s;
}

/// A spotlight, a sphere light, directional light and two environments over that floor, one each.
inline std::vector<scene> floors_under_each_light()
{
    std::vector<scene> all(5, bare_floor());
    all[0].spot_lights = {{"spot", {0.2, 1.1, 0.1}, {0.1, -1, 0}, 15, 40, dvec3(10, 5, 2)}};
    all[1].sphere_lights = {{"globe", {0.3, 1.5, -0.2}, 0.25, dvec3(10, 5, 2)}};
    all[1].camera = {{0.1, 1, 0}, {0, 0, 0}, {0, 0, 1}, 100}; // below it
    all[2].directional_lights = {{"sun", {0.3, -2, 0.5}, dvec3(3, 2, 1)}};
    all[3].environment_lights = {{"sky", "", sky_with_a_sun(), dvec3(1, 2, 3), {1, 0.5, 0.25}, 35}};
    all[4].environment_lights = {{"white", "", nullptr, dvec3(1)}};
    return all;
}

/// A floor with a ball under 100 lights of six kinds, most of them far from any point.
inline scene many_lights()
{
    auto s = bare_floor();
    s.name = "many_lights";
    s.spheres = {{{0.5, 0.4, 0.3}, 0.4, 0}};
    const auto pyramid = std::make_shared<const mesh>(
        mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
    for (int i = 0; i < 98; ++i) {
        const double x = -2.8 + 0.6 * (i % 10), z = -2.8 + 0.6 * (i / 10), y = 0.3 + 0.1 * (i * 7 % 11);
        const dvec3 power(0.2 + 0.1 * (i % 5), 0.3, 0.1 + 0.05 * (i % 7));
        if (i % 5 == 0)
            s.point_lights.push_back({"bulb", {x, y, z}, power});
        else if (i % 5 == 1)
            s.rectangle_lights.push_back({"lamp", {x, y, z}, {0.1, 0.05, 0}, {0, 0, 0.1}, power}); // upside down
        else if (i % 5 == 2)
            s.sphere_lights.push_back({"globe", {x, y, z}, 0.05, power});
        else if (i % 5 == 3)
            s.spot_lights.push_back({"spot", {x, y, z}, {0.2, -1, 0.1}, 10, 50, power});
        else
            s.mesh_lights.push_back({"ember", {"", pyramid, glm::dmat3(0.1), {x, y, z}, 0}, power});
    }
    for (int i = 0; i < 5; ++i)
        s.rectangle_lights.push_back({"lamp", {-2.0 + i, 1.5, 0}, {0.1, 0, 0}, {0, 0, 0.1}, dvec3(0.5)});
    s.directional_lights = {{"sun", {0.3, -1, 0.2}, dvec3(0.05)}};
    s.environment_lights = {{"sky", "", nullptr, dvec3(0.02)}};
    s.render.view.light_samples = 8;
    return s;
}

/// all_shapes_and_meshes() under every kind of light, with rough metal, a glass mesh that is rough and has normals, and
/// plastic, smooth and rough, of which one is a mesh with normals.
inline scene all_lights()
{
    auto s = all_shapes_and_meshes();
    s.name = "all_lights";
    s.materials[1].roughness = 0.4;
    s.materials.push_back({"frosted", material_kind::glass, dvec3(0.95), 1.5, 0.3});
    s.meshes[0].material = 4;
    s.materials.push_back({"red plastic", material_kind::plastic, {0.7, 0.1, 0.1}, 1.5, 0.4});
    s.materials.push_back({"varnish", material_kind::plastic, {0.6, 0.4, 0.2}, 1.6});
    s.spheres[1].material = 5;
    s.boxes[0].material = 6;
    s.polygons[1].material = 6;
    auto smooth = s.meshes[0];
    smooth.material = 5;
    smooth.offset = {-1.2, 0.2, -0.7};
    s.meshes.push_back(smooth);
    s.sphere_lights = {{"globe", {-1.2, 1.3, 0.8}, 0.15, dvec3(6, 7, 8)}};
    s.spot_lights = {{"spot", {1.5, 1.6, -1}, {-1, -1.5, 0.6}, 10, 35, dvec3(8, 4, 4)}};
    s.directional_lights = {{"sun", {0.4, -1, 0.6}, dvec3(0.8, 0.7, 0.4)}};
    s.environment_lights = {{"sky", "", sky_with_a_sun(), dvec3(0.2), {0, 1, 0}, 70}};
    return s;
}

} // namespace photongrid::testing
