// Scenes with mixtures, with surfaces that are clear in part, and with textures of numbers.
#pragma once

#include "mesh_sets.hpp"
#include "texture_scenes.hpp"

namespace photongrid::testing {

/// A texture of one row whose texels have these values in one channel, and others in the rest.
inline texture row_of_numbers(const std::vector<double>& values, texture_channel channel)
{
    texture t{static_cast<std::uint32_t>(values.size()), 1, {}};
    std::mt19937 random(7);
    for (const double v : values) {
        t.texels.emplace_back(random() & 65535u, random() & 65535u, random() & 65535u, random() & 65535u);
        t.texels.back()[static_cast<int>(channel)] = static_cast<std::uint16_t>(v * 65535 + 0.5);
    }
    return t;
}
inline texture_use use_of_numbers(const std::vector<double>& values, texture_channel channel)
{
    return {"", std::make_shared<const texture>(row_of_numbers(values, channel)), texture_wrap::clamp, {1, 1}, {0, 0},
        channel};
}

/// A mixture of the materials `first` and `second`.
inline material mixture_of(std::uint32_t first, std::uint32_t second, double share, texture_use texture = {})
{
    material m{"mixture", material_kind::mixture};
    m.parts = {first, second};
    m.share = share;
    m.share_texture = std::move(texture);
    return m;
}

/// The Cornell box of meshes: its floor is a mixture with textures, of what is rough by a texture among others; its
/// mirror ball one of plastic and metal, another ball, with normals of vertices, one of a mirror and what is matte; and
/// between those and the lamp is a sheet with holes that have soft edges.
inline scene mixed_cornell()
{
    auto s = with_meshes(small_cornell());
    s.name = "mixed_cornell";
    const auto picture = std::make_shared<const texture>(random_texture(7, 5, 3));
    const auto add = [&](material m) {
        s.materials.push_back(std::move(m));
        return static_cast<std::uint32_t>(s.materials.size() - 1);
    };
    const auto wood = add({"wood", material_kind::lambertian, dvec3(0.9), 1.5, 0,
        {"", picture, texture_wrap::repeat, {3, 2}, {0.25, 0.5}}});
    material steel{"steel", material_kind::metal, {0.9, 0.8, 0.7}, 1.5, 0.6};
    steel.roughness_texture = use_of_numbers({1, 0.3, 0.8}, texture_channel::green);
    const auto plastic = add({"plastic", material_kind::plastic, {0.3, 0.6, 0.9}});
    const auto clay = add({"clay", material_kind::lambertian, {0.8, 0.5, 0.3}});
    const auto silver = add({"silver", material_kind::mirror, dvec3(0.95)});
    const auto floor
        = add(mixture_of(wood, add(std::move(steel)), 0.8, use_of_numbers({0, 1, 0.5, 1}, texture_channel::blue)));
    auto leaf = s.materials[2];
    leaf.opacity = 0.9;
    leaf.opacity_texture = use_of_numbers({1, 0, 0, 1, 0.4, 1}, texture_channel::alpha);
    const auto leaves = add(std::move(leaf));
    s.meshes[0] = {"", std::make_shared<const mesh>(textured_rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, 1})), glm::dmat3(1),
        dvec3(0), floor};
    s.meshes.push_back(
        {"", std::make_shared<const mesh>(textured_rectangle({0.2f, 0.7f, 0.2f}, {0.6f, 0, 0}, {0, 0, 0.6f})),
            glm::dmat3(1), dvec3(0), leaves});
    s.meshes.push_back({"", std::make_shared<const mesh>(smooth_ball(8)), glm::dmat3(0.12), {0.75, 0.55, 0.3},
        add(mixture_of(silver, clay, 0.4))});
    s.spheres[0].material = add(mixture_of(plastic, 3, 0.3));
    return s;
}

} // namespace photongrid::testing
