// The camera and the light of scenes whose files have none, and the exposure of pictures that have none.
#pragma once

#include "import_tests.hpp"

#include <photongrid/io/import/default_view.hpp>
#include <photongrid/io/tone_map.hpp>

#include <gtest/gtest.h>

namespace photongrid::testing {
namespace {

    /// A box as a mesh, its corners from low to high.
    placed_mesh box_of_mesh(const dvec3& low, const dvec3& high)
    {
        mesh m;
        for (int corner = 0; corner < 8; ++corner)
            m.positions.emplace_back((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                (corner & 4) != 0 ? high.z : low.z);
        for (const glm::uvec4 q : {glm::uvec4(0, 1, 3, 2), glm::uvec4(4, 6, 7, 5), glm::uvec4(0, 4, 5, 1),
                 glm::uvec4(2, 3, 7, 6), glm::uvec4(0, 2, 6, 4), glm::uvec4(1, 5, 7, 3)}) {
            m.triangles.emplace_back(q.x, q.y, q.z);
            m.triangles.emplace_back(q.x, q.z, q.w);
        }
        return {"", std::make_shared<const mesh>(m)};
    }
    scene scene_of(std::vector<placed_mesh> meshes)
    {
        scene s;
        s.materials = {{"white"}};
        s.meshes = std::move(meshes);
        return s;
    }
    /// The largest part of the picture's half that a corner of the box is away from its middle; above 1: it is outside.
    double farthest_in_picture(const camera& c, const dvec3& low, const dvec3& high)
    {
        const detail::camera_axes axes(c);
        double most = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const dvec3 way = dvec3((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                                  (corner & 4) != 0 ? high.z : low.z)
                - c.position;
            const double depth = glm::dot(way, axes.forward) * std::tan(glm::radians(c.vertical_fov) / 2);
            EXPECT_GT(depth, 0);
            for (const auto& axis : {axes.right, axes.up})
                most = std::max(most, std::abs(glm::dot(way, axis)) / depth);
        }
        return most;
    }

    TEST(default_view, a_thing_fills_the_picture)
    {
        for (const dvec3 size : {dvec3(1, 1, 1), dvec3(5, 0.1, 0.2), dvec3(0.1, 9, 0.1), dvec3(4, 4, 0), dvec3(0, 1, 1),
                 dvec3(1e4, 10, 1e4), dvec3(1e-4)})
            for (const dvec3 at : {dvec3(0), dvec3(5.4e6, 100, -5e5)}) {
                auto m = box_of_mesh(-0.5 * size, 0.5 * size);
                m.offset = at;
                auto s = scene_of({m});
                s.environment_lights.push_back({"sky", "", nullptr, dvec3(1)});
                const auto chosen = default_camera(s);
                EXPECT_FALSE(chosen.is_inside);
                const double part = farthest_in_picture(chosen.view, at - 0.5 * size, at + 0.5 * size);
                EXPECT_LE(part, 0.95);
                EXPECT_GT(part, 0.8);
            }
    }

    TEST(default_view, a_flat_thing_is_seen_from_its_face)
    {
        for (const int axis : {0, 1, 2}) {
            dvec3 half(1);
            half[axis] = 0.01;
            auto s = scene_of({box_of_mesh(-half, half)});
            s.environment_lights.push_back({"sky", "", nullptr, dvec3(1)});
            const auto c = default_camera(s).view;
            EXPECT_GT(std::abs(glm::normalize(c.look_at - c.position)[axis]), 0.55) << axis;
        }
    }

    TEST(default_view, what_stands_on_a_wide_ground_fills_the_picture)
    {
        const dvec3 low(-0.5, 0, -0.5), high(0.5, 1, 0.5);
        auto s = scene_of({box_of_mesh({-20, -0.01, -20}, {20, 0, 20}), box_of_mesh(low, high)});
        s.directional_lights.push_back({"sun"});
        EXPECT_GT(farthest_in_picture(default_camera(s).view, low, high), 0.5);
        EXPECT_LT(farthest_in_picture(default_camera(s).view, low, high), 1);
    }

    TEST(default_view, of_a_closed_room_is_within_it)
    {
        auto room = scene_of({box_of_mesh({-2, 0, -3}, {2, 2.5, 3}), box_of_mesh({-0.3, 0, -0.3}, {0.3, 0.5, 0.3})});
        room.point_lights = {{"bulb", {0.5, 2, 0.5}, dvec3(10)}};
        const auto chosen = default_camera(room);
        EXPECT_TRUE(chosen.is_inside);
        EXPECT_LT(std::abs(chosen.view.position.x), 2);
        EXPECT_LT(std::abs(chosen.view.position.z), 3);
        room.point_lights[0].position = {0.5, 5, 3.5}; // outside: what it lights is seen from there
        EXPECT_FALSE(default_camera(room).is_inside);
        room.point_lights[0].position = {0.5, 2, 0.5};
        room.environment_lights.push_back({"sky", "", nullptr, dvec3(1)});
        EXPECT_FALSE(default_camera(room).is_inside);
    }

    TEST(default_view, the_sky_has_a_bright_patch_and_is_dim_below)
    {
        const auto sky = default_sky();
        EXPECT_NO_THROW(check(sky));
        const auto [least, most] = std::minmax_element(
            sky.radiance.begin(), sky.radiance.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
        EXPECT_GT(most->y, 5 * sky.radiance[0].y);
        EXPECT_GT(sky.radiance[0].y, 1.2f * least->y);
        EXPECT_LT((most - sky.radiance.begin()) / sky.width, sky.height / 2);
    }

    TEST(fitting_exposure, ignores_the_dark_around_a_spotlight)
    {
        image lit{.width = 100, .height = 1, .pixels = std::vector<glm::vec3>(100, glm::vec3(0.5f))};
        const double alone = fitting_exposure(lit).value();
        EXPECT_NEAR(alone, std::log2(0.18 / 0.5), 1e-6);
        for (std::size_t i = 0; i < 80; ++i)
            lit.pixels[i] = glm::vec3(1e-4f);
        EXPECT_NEAR(fitting_exposure(lit).value(), alone, 1e-6);
        for (std::size_t i = 0; i < 50; ++i)
            lit.pixels[i] = glm::vec3(0.0625f); // three stops darker: a room, not the dark
        EXPECT_NEAR(fitting_exposure(lit).value(), std::log2(0.18) - (50 * -4 + 20 * -1) / 70.0, 1e-6);
        EXPECT_FALSE(fitting_exposure({.width = 1, .height = 1, .pixels = {glm::vec3(0)}}).has_value());
    }

    TEST_F(import_folder, a_scene_with_z_up_is_turned)
    {
        write("plan.obj", "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n");
        const auto path = (folder / "plan.obj").string();
        const auto plain = import_scene(path), turned = import_scene(path, {.unit = 2.0, .z_up = true});
        const auto has_hint = [](const imported_scene& s) {
            const auto notes = notes_of(s);
            return std::any_of(
                notes.begin(), notes.end(), [](const std::string& n) { return n.find("--z-up") != std::string::npos; });
        };
        EXPECT_TRUE(has_hint(plain));
        EXPECT_FALSE(has_hint(turned));
        const auto box = bounds_of(turned.scene);
        expect_near(box.low, {0, 0, -6});
        expect_near(box.high, {8, 2, 0});
        const auto c = corners_of(turned.scene.meshes.at(0), 0);
        EXPECT_GT(glm::cross(c[1] - c[0], c[2] - c[0]).y, 0) << "it is mirrored";
        write("own.json", R"({"photongrid": 1})");
        EXPECT_THROW(import_scene((folder / "own.json").string(), {.z_up = true}), scene_error);
    }

    TEST_F(import_folder, other_files_are_named_as_such)
    {
        for (const auto& [name, content, said] :
            {std::tuple("part.stl", "solid part", "is no scene that photongrid reads"),
                std::tuple("crate.mtl", "newmtl wood", "open the .obj that names it"),
                std::tuple("wood.png", "\x89PNG", "expected .json, .gltf, .glb, .obj, .ply, .pbrt or .xml")}) {
            write(name, content);
            try {
                import_scene((folder / name).string());
                ADD_FAILURE() << name;
            } catch (const scene_error& e) {
                EXPECT_NE(std::string(e.what()).find(said), std::string::npos) << e.what();
            }
        }
    }

    TEST_F(import_folder, a_lamp_alone_is_a_scene)
    {
        write("neon.obj", "mtllib n.mtl\nusemtl neon\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        write("n.mtl", "newmtl neon\nKe 1 2 3\n");
        const auto s = import_scene((folder / "neon.obj").string()).scene;
        EXPECT_EQ(count_shapes(s), 0u);
        EXPECT_EQ(s.mesh_lights.size(), 1u);
        EXPECT_NO_THROW(check(s));
    }

} // namespace
} // namespace photongrid::testing
