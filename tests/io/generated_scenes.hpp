// Scenes by RapidCheck: each has some of every shape, material and light, with numbers that single precision rounds.
#pragma once

#include <photongrid/scene/scene.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>

namespace photongrid {
namespace {

    /// A folder that is removed with all that lies in it.
    class test_folder {
    public:
        explicit test_folder(const std::string& name)
            : path(std::filesystem::temp_directory_path()
                / ("photongrid_" + name + "_" + std::to_string(std::random_device{}())))
        {
            std::filesystem::create_directories(path);
        }
        test_folder(const test_folder&) = delete;
        test_folder& operator=(const test_folder&) = delete;
        ~test_folder() { std::filesystem::remove_all(path); }
        std::string file(const std::string& name) const { return (path / name).string(); }
        std::filesystem::path path;
    };

    [[maybe_unused]] std::string bytes_in(const std::filesystem::path& file)
    {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    /// What scenes are made of, by a number that RapidCheck chooses. `for_pbrt`: only what pbrt-v4 has too.
    class scene_generator {
    public:
        scene_generator(std::uint32_t seed, bool for_pbrt) : random_(seed), for_pbrt_(for_pbrt) {}

        scene any_scene()
        {
            scene s;
            s.name = "generated";
            s.camera
                = {.position = point(), .look_at = {50, 1, 2}, .up = {0.1, 1, 0.2}, .vertical_fov = 10 + 60 * share()};
            s.render.output.width = 20 + below(40);
            s.render.output.height = 20 + below(40);
            add_materials(s);
            const auto plain = [&] { return below(3); }; // these are no glass, and have neither textures nor an opacity
            s.spheres.push_back({point(), size(), 0});
            for (auto n = below(3); n > 0; --n) {
                s.spheres.push_back({point(), size(), plain()});
                s.cylinders.push_back({point(), point(), size(), plain()});
                s.disks.push_back({point(), direction(), size(), plain()});
                if (for_pbrt_)
                    continue;
                s.cones.push_back({point(), point(), size(), plain()});
                s.paraboloids.push_back({point(), point(), size(), plain()});
                s.polygons.push_back({{point(), point(), point()}, plain()});
                const glm::dmat3 turned = rotation_about(direction(), 360 * share());
                s.boxes.push_back({point(), turned[0] * size(), turned[1] * size(), turned[2] * size(), plain()});
            }
            for (auto n = below(5); n > 0; --n)
                add_mesh(s);
            add_lights(s);
            check(s);
            return s;
        }

        std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }
        double share() { return (1 + below(1 << 20)) / double{(1 << 20) + 3}; }
        double size() { return 0.1 + share(); }
        dvec3 point() { return dvec3(share(), share(), share()) * 20.0 - 10.0; }
        dvec3 rgb() { return {share(), share(), share()}; }
        dvec3 direction() { return dvec3(share(), share(), share()) - dvec3(0.1, 0.7, 1.2); }

        /// Three vertices for each triangle; normals are near that of the triangle, so that they say the same of its
        /// outside.
        std::shared_ptr<const mesh> surface(std::uint32_t triangles)
        {
            mesh m;
            const bool has_normals = below(2) == 0, has_colors = !for_pbrt_ && below(3) == 0;
            for (std::uint32_t t = 0; t < triangles; ++t) {
                const std::array<dvec3, 3> corners{point(), point(), point()};
                for (const auto& c : corners) {
                    m.positions.emplace_back(c);
                    m.texture_coordinates.emplace_back(3 * share() - 1, share());
                    if (has_normals)
                        m.normals.emplace_back(
                            glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) + 0.1 * rgb());
                    if (has_colors)
                        m.colors.emplace_back(rgb());
                }
                m.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
            }
            return std::make_shared<const mesh>(std::move(m));
        }

        texture_use picture(bool is_number)
        {
            texture made{1 + below(5), 1 + below(5), {}};
            const auto alpha = is_number ? below(2) : 0;
            for (std::size_t i = 0; i < std::size_t{made.width} * made.height; ++i) {
                const auto texel = [&] { return static_cast<std::uint16_t>(alpha ? 257 * below(256) : below(65536)); };
                made.texels.emplace_back(texel(), texel(), texel(), alpha ? texel() : std::uint16_t{65535});
            }
            texture_use t;
            t.map = std::make_shared<const texture>(std::move(made));
            t.wrap = below(2) == 0 ? texture_wrap::clamp : texture_wrap::repeat;
            t.scale = {4 * share(), 4 * share() - 2};
            t.offset = {share(), -share()};
            if (is_number)
                t.channel = static_cast<texture_channel>(below(4));
            return t;
        }

    private:
        void add_materials(scene& s)
        {
            auto& all = s.materials;
            all.push_back({.name = "matte", .reflectance = rgb()});
            all.push_back({.name = "metal",
                .kind = material_kind::metal,
                .reflectance = rgb(),
                .roughness = 0.1 + 0.9 * share()});
            all.push_back({.name = "plastic",
                .kind = material_kind::plastic,
                .reflectance = rgb(),
                .index_of_refraction = 1 + share(),
                .roughness = 0.1 + 0.9 * share()});
            all.push_back({.name = "mirror", .kind = material_kind::mirror, .reflectance = rgb()});
            all.push_back({.name = "glass",
                .kind = material_kind::glass,
                .reflectance = for_pbrt_ ? dvec3(1) : rgb(),
                .index_of_refraction = 1 + share(),
                .roughness = below(2) == 0 ? 0 : 0.1 + 0.9 * share()});
            all.push_back({.name = "papered", .reflectance = rgb(), .texture = picture(false)});
            all.push_back({.name = "blend", .kind = material_kind::mixture, .parts = {0, 3}, .share = share()});
            all.push_back({.name = "leaf", .reflectance = rgb(), .opacity = share()});
            all.push_back({.name = "twig",
                .kind = material_kind::mixture,
                .opacity = share(),
                .parts = {0, 1},
                .share = share()});
            if (for_pbrt_) // textures of numbers are rounded to 16 bits again there
                return;
            all[7].opacity_texture = picture(true);
            all[8].share_texture = picture(true);
            all.push_back({.name = "worn",
                .kind = material_kind::metal,
                .reflectance = rgb(),
                .roughness = share(),
                .roughness_texture = picture(true)});
        }

        void add_mesh(scene& s)
        {
            placed_mesh m;
            m.surface = !s.meshes.empty() && below(3) == 0 ? s.meshes.back().surface
                                                           : surface(1 + below(for_pbrt_ ? 60 : 100));
            m.linear
                = rotation_about(direction(), 360 * share()) * glm::dmat3(size(), 0, 0, 0, size(), 0, 0, 0, size());
            if (below(4) == 0)
                m.linear[0] = -m.linear[0];
            m.offset = point();
            m.material = below(static_cast<std::uint32_t>(s.materials.size()));
            s.meshes.push_back(std::move(m));
        }

        void add_lights(scene& s)
        {
            const auto name = [&] { return "lamp " + std::to_string(count_lights(s)); };
            s.point_lights.push_back({name(), point(), rgb() * 100.0});
            for (auto n = below(2); n > 0; --n) {
                const auto turned = rotation_about(direction(), 360 * share());
                s.rectangle_lights.push_back({name(), point(), turned[0] * size(), turned[1] * size(), rgb()});
                s.sphere_lights.push_back({name(), point(), size(), rgb()});
                s.mesh_lights.push_back({name(), {}, rgb()});
                auto& lit = s.mesh_lights.back().surface;
                lit.surface = surface(3);
                if (for_pbrt_) // what has no meaning is not written
                    lit.surface = std::make_shared<const mesh>(mesh{lit.surface->positions, lit.surface->triangles});
                lit.offset = point();
                const double outer = 10 + 70 * share();
                s.spot_lights.push_back({name(), point(), direction(), outer * share(), outer, rgb()});
                s.directional_lights.push_back({name(), direction(), rgb()});
            }
            if (below(2) == 0)
                return;
            environment_light sky{.name = name(), .file = "", .map = nullptr, .radiance = rgb()};
            if (!for_pbrt_) {
                environment_map map{1 + below(5), 1 + below(5), {}};
                for (std::size_t i = 0; i < std::size_t{map.width} * map.height; ++i)
                    map.radiance.emplace_back(rgb() * 1000.0);
                sky.map = std::make_shared<const environment_map>(std::move(map));
                sky.axis = direction();
                sky.degrees = 300 * share();
            }
            s.environment_lights.push_back(std::move(sky));
        }

        std::mt19937 random_;
        bool for_pbrt_;
    };

    /// A square with texture coordinates, whose material has these textures.
    [[maybe_unused]] scene papered_square(const texture_use& color, const texture_use& opacity)
    {
        scene s;
        s.name = "square";
        s.camera.position = {0, 0, 4};
        s.materials = {{.name = "paper", .reflectance = dvec3(0.5), .texture = color, .opacity_texture = opacity}};
        const mesh square{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {},
            {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        s.meshes.push_back({.file = "",
            .surface = std::make_shared<const mesh>(square),
            .linear = glm::dmat3(1),
            .offset = dvec3(0),
            .material = 0});
        s.point_lights.push_back({"lamp", {0, 0, 4}, dvec3(10)});
        return s;
    }

    [[maybe_unused]] texture_use use_of(texture t, texture_channel channel = texture_channel::red)
    {
        texture_use made;
        made.map = std::make_shared<const texture>(std::move(t));
        made.channel = channel;
        return made;
    }

} // namespace
} // namespace photongrid
