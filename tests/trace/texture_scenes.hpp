// Scenes with textures and colours of vertices.
#pragma once

#include "../scene/test_scenes.hpp"

#include <random>

namespace photongrid::testing {

/// A texture of random colours.
inline texture random_texture(std::uint32_t width, std::uint32_t height, std::uint32_t seed)
{
    texture t{width, height, {}};
    std::mt19937 random(seed);
    for (std::uint32_t i = 0; i < width * height; ++i)
        t.texels.emplace_back(random() & 65535u, random() & 65535u, random() & 65535u, 65535u);
    return t;
}

/// A rectangle as a mesh, whose texture coordinates are (0, 0) at its corner and (1, 1) across from it.
inline mesh textured_rectangle(const glm::vec3& corner, const glm::vec3& edge_u, const glm::vec3& edge_v)
{
    return {{corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v}, {{0, 1, 2}, {0, 2, 3}}, {},
        {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
}

/// A rectangle of 1.5 m x 1 m that faces the camera in even light, and more white ones behind the camera, which nothing
/// of what is seen depends on.
inline scene rectangle_in_even_light(mesh rectangle, texture_use texture)
{
    scene s;
    s.name = "rectangle";
    s.materials = {{"picture", material_kind::lambertian, {1, 0.5, 0.25}, 1.5, 0, std::move(texture)}};
    s.meshes = {{"", std::make_shared<const mesh>(std::move(rectangle)), glm::dmat3(1), dvec3(0), 0}};
    s.directional_lights = {{"sun", {0, 0, -1}, dvec3(M_PI)}}; // so that radiance is the reflectance
    s.camera = {{0.75, 0.5, 3}, {0.75, 0.5, 0}, {0, 1, 0}, 16};
    s.render = {.map = {.photons = 10},
        .estimate = {.k = 10, .max_radius = 0.2},
        .view = {.spp = 1},
        .output = {.width = 48, .height = 32, .only = light_part::direct}};
    return s;
}

/// The Cornell box of meshes, with a texture on its floor, colours on its back wall, and a textured mirror.
inline scene textured_cornell()
{
    auto s = with_meshes(small_cornell());
    s.name = "textured_cornell";
    const auto picture = std::make_shared<const texture>(random_texture(7, 5, 3));
    s.materials.push_back({"wood", material_kind::lambertian, dvec3(0.9), 1.5, 0,
        {"", picture, texture_wrap::repeat, {3, 2}, {0.25, 0.5}}});
    s.materials.push_back({"foil", material_kind::mirror, dvec3(1), 1.5, 0, {"", picture, texture_wrap::clamp}});
    s.meshes[0] = {"", std::make_shared<const mesh>(textured_rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, 1})), glm::dmat3(1),
        dvec3(0), 5};
    auto back = *s.meshes[2].surface;
    back.colors = {{1, 0.1f, 0.1f}, {0.2f, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    s.meshes[2].surface = std::make_shared<const mesh>(back);
    s.meshes.push_back(
        {"", std::make_shared<const mesh>(textured_rectangle({0.1f, 0.5f, 0.95f}, {0.3f, 0, 0}, {0, 0.3f, 0})),
            glm::dmat3(1), dvec3(0), 6});
    return s;
}

} // namespace photongrid::testing
