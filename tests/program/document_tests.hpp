// The document of the window: its parts, and changes that can be undone.
#pragma once

#include "../scene/test_scenes.hpp"
#include "viewer/document.hpp"
#include "viewer/saved_files.hpp"
#include <photongrid/io/scene_file.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace photongrid::viewer {
namespace {
    using photongrid::testing::small_cornell;

    const std::string scenes = PHOTONGRID_SCENES;

    std::vector<std::string> names(const scene& s)
    {
        std::vector<std::string> all;
        for (const auto& p : parts_of(s))
            all.push_back(p.name);
        return all;
    }

    version begun(const scene& s) { return {s, s.render, "serial"}; }

    TEST(saved_files, refuse_a_scene_that_cannot_be_rendered)
    {
        const std::string text = R"({"photongrid": 1, "units": {"length": "m", "power": "W"},
 "camera": {"position": [0, 1, 5], "look_at": [0, 0, 0], "vertical_fov": 40},
 "materials": {"clear": {"type": "glass", "index_of_refraction": 1.5}, "white": {"type": "lambertian", "reflectance": 0.7}},
 "shapes": [{"type": "sphere", "center": [0, 1, 0], "radius": 0.5, "material": "clear"},
  {"type": "sphere", "center": [2, 1, 0], "radius": 0.5, "material": "clear"},
  {"type": "disk", "center": [0, 0, 0], "normal": [0, 1, 0], "radius": 3, "material": "white"}],
 "lights": [{"type": "point", "position": [0, 3, 0], "power": 10}],
 "render": {"size": [64, 48], "photons": 1000, "k": 20, "grid": [4, 1, 4], "max_radius": 0.25}}
)";
        namespace fs = std::filesystem;
        const auto folder = fs::temp_directory_path() / ("photongrid_saved_" + std::to_string(::getpid()));
        fs::create_directories(folder);
        const auto s = parse_scene("glass.json", text);
        saved_files files({.path = "glass.json",
            .text = text,
            .stem = (folder / "glass").string(),
            .scene = s,
            .settings = s.render});
        auto v = begun(s);
        EXPECT_FALSE(files.lacks(v));
        v.scene.spheres[1].center.x = 0.5;
        EXPECT_TRUE(files.lacks(v));
        const auto refusal = files.save(v);
        EXPECT_NE(refusal.find("not saved"), std::string::npos) << refusal;
        EXPECT_NE(refusal.find("overlaps"), std::string::npos) << refusal;
        EXPECT_TRUE(files.lacks(v));
        EXPECT_TRUE(fs::is_empty(folder));
        v.scene.spheres[1].center.x = 1.5;
        EXPECT_EQ(files.save(v), "saved " + (folder / "glass-changed.json").string());
        EXPECT_FALSE(files.lacks(v));
        EXPECT_EQ(read_scene((folder / "glass-changed.json").string()).spheres[1].center.x, 1.5);
        EXPECT_EQ(files.save(v), "saved " + (folder / "glass-changed-2.json").string());
        fs::remove_all(folder);
    }

    TEST(saved_files, that_name_others_lie_beside_their_scene)
    {
        namespace fs = std::filesystem;
        const auto folder = fs::temp_directory_path() / ("photongrid_beside_" + std::to_string(::getpid()));
        fs::create_directories(folder);
        const auto write = [&](const char* name, const std::string& content) {
            std::ofstream(folder / name, std::ios::binary) << content;
        };
        const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";
        write("triangle.obj", triangle);
        const std::string text = R"({"photongrid": 1, "units": {"length": "m", "power": "W"},
 "camera": {"position": [0, 1, 5], "look_at": [0, 0, 0], "vertical_fov": 40},
 "materials": {"white": {"type": "lambertian", "reflectance": 0.7}},
 "shapes": [{"type": "mesh", "file": "triangle.obj", "material": "white"}],
 "lights": [{"type": "point", "position": [0, 3, 0], "power": 10}],
 "render": {"size": [64, 48], "photons": 1000, "k": 20, "max_radius": 0.25}}
)";
        const auto path = (folder / "scene.json").string();
        const auto s = parse_scene(path, text);
        saved_files files({.path = path,
            .text = text,
            .stem = "triangle",
            .scene = s,
            .settings = s.render,
            .files = {{path, {}}, {(folder / "triangle.obj").string(), {}}}});
        auto v = begun(s);
        v.scene.point_lights[0].position.y = 4;
        const auto saved = (folder / "triangle-changed.json").string();
        EXPECT_EQ(files.save(v), "saved " + saved);
        EXPECT_EQ(read_scene(saved).point_lights[0].position.y, 4);
        write("triangle.obj", triangle + "f 1 3 2\n");
        const auto refusal = files.save(v);
        EXPECT_EQ(refusal.substr(0, 60), "not saved: a file that the scene names has changed since it ") << refusal;
        fs::remove_all(folder);
    }

    TEST(scene_parts, blocks_move_whole)
    {
        const auto s = read_scene(scenes + "/cornell_blocks.json");
        const auto parts = parts_of(s);
        std::size_t polygons = 0, blocks = 0;
        for (const auto& p : parts) {
            const auto of_part = items_of<polygon>(s, p);
            polygons += of_part.size();
            blocks += of_part.size() == 5 && s.materials[of_part[0]->material].name == "white" ? 1u : 0u;
        }
        EXPECT_EQ(polygons, s.polygons.size()) << "each polygon is in one part";
        EXPECT_GE(blocks, 2u);
        EXPECT_EQ(items_of<rectangle_light>(s, parts.back()).size(), 1u);
        EXPECT_EQ(names(small_cornell()),
            (std::vector<std::string>{"sphere, mirror", "sphere, glass", "5 polygons, white", "lamp"}));
    }

    TEST(scene_parts, what_is_moved_moves_alone_and_back)
    {
        const auto s = testing::all_shapes_and_meshes();
        const auto parts = parts_of(s);
        EXPECT_EQ(parts.back().name, "mesh, gold");
        for (std::size_t p = 0; p < parts.size(); ++p) {
            auto moved = s;
            move(moved, parts[p], {0.25, -0.5, 1});
            EXPECT_FALSE(moved == s) << parts[p].name;
            for (std::size_t q = 0; q < parts.size(); ++q)
                if (q != p) {
                    auto both = s;
                    move(both, parts[q], {0.25, -0.5, 1});
                    EXPECT_FALSE(both == moved) << parts[p].name << " and " << parts[q].name << " are the same";
                }
            move(moved, parts[p], {-0.25, 0.5, -1});
            auto again = parts_of(moved);
            EXPECT_EQ(again, parts);
        }
    }

    TEST(scene_parts, a_pick_finds_the_mesh_that_is_seen)
    {
        auto s = testing::with_meshes(small_cornell());        // floor, ceiling, back, red and green
        s.point_lights = {{"bulb", {0.1, 0.2, -2}, dvec3(1)}}; // behind the camera
        const auto parts = parts_of(s);
        const auto seen_at = [&](double x, double y) {
            const auto found = pick(s, parts, 200, 200, x, y);
            const auto meshes
                = found ? items_of<placed_mesh>(s, parts[found->part]) : std::vector<const placed_mesh*>();
            return meshes.size() == 1 ? meshes[0] - s.meshes.data() : -1;
        };
        EXPECT_EQ(seen_at(100, 195), 0);
        EXPECT_EQ(seen_at(100, 20), 1);
        EXPECT_EQ(seen_at(100, 60), 2);
        EXPECT_EQ(seen_at(3, 100) + seen_at(197, 100), 3 + 4);
        EXPECT_EQ(seen_at(60, 150), -1) << "a ball";
    }

    TEST(scene_parts, a_pick_finds_what_is_seen_and_a_drag_keeps_it_under_the_mouse)
    {
        const auto s = small_cornell();
        const auto parts = parts_of(s);
        const auto& c = s.camera;
        // Where points of the scene are in a picture of 200 x 200: the camera looks along z.
        const auto place = [&](const dvec3& p) {
            const double half_height = std::tan(glm::radians(c.vertical_fov) / 2) * (p.z - c.position.z);
            return glm::dvec2(
                100 - 100 * (p.x - c.position.x) / half_height, 100 - 100 * (p.y - c.position.y) / half_height);
        };
        for (const auto& [point, name] :
            {std::pair{dvec3(0.7, 0.2, 0.45), "sphere, mirror"}, {dvec3(0.3, 0.18, 0.17), "sphere, glass"},
                {dvec3(0.5, 0.9, 1), "5 polygons, white"}, {dvec3(0.5, 0.999, 0.5), "lamp"}}) {
            const auto at = place(point);
            const auto found = pick(s, parts, 200, 200, at.x, at.y);
            ASSERT_TRUE(found) << name;
            EXPECT_EQ(parts[found->part].name, name);
            if (items_of<sphere>(s, parts[found->part]).empty()) {
                EXPECT_LT(glm::length(found->position - point), 1e-6) << name;
            }
            for (const bool level : {false, true}) {
                const auto to = on_plane(c, sight_line_at(c, 200, 200, at.x + 11, at.y - 4), found->position, level);
                if (!to) // its plane is seen from the edge
                    continue;
                auto moved = s;
                move(moved, parts[found->part], *to - found->position);
                const auto there = place(*to);
                EXPECT_NEAR(there.x, at.x + 11, 1e-6) << name;
                EXPECT_NEAR(there.y, at.y - 4, 1e-6) << name;
                if (level) {
                    EXPECT_NEAR(to->y, found->position.y, 1e-9);
                }
            }
        }
        EXPECT_FALSE(pick(s, parts, 200, 200, -300, 100)) << "past the wall there is nothing";

        auto dark = testing::all_shapes();
        const dvec3 to = glm::normalize(dark.point_lights[0].position - dark.camera.position);
        dark.camera.look_at = dark.camera.position + to;
        const auto bulb = pick(dark, parts_of(dark), 100, 100, 50, 55);
        ASSERT_TRUE(bulb);
        EXPECT_EQ(parts_of(dark)[bulb->part].name, "bulb") << "no ray meets it, and yet it can be taken";
    }

    TEST(document, the_camera_turns_about_what_it_looks_at)
    {
        document d(begun(small_cornell()));
        const auto c = d.now().scene.camera;
        const double distance = glm::length(c.position - c.look_at);
        d.orbit(90, 0);
        EXPECT_NEAR(glm::length(d.now().scene.camera.position - c.look_at), distance, 1e-12);
        EXPECT_NEAR(glm::dot(d.now().scene.camera.position - c.look_at, c.position - c.look_at), 0, 1e-12);
        d.orbit(-90, 0);
        EXPECT_LT(glm::length(d.now().scene.camera.position - c.position), 1e-12);
        for (int i = 0; i < 50; ++i) { // never over the pole
            d.orbit(3, i < 25 ? 20 : -20);
            EXPECT_NO_THROW(check(d.now().scene.camera));
            EXPECT_NEAR(glm::length(d.now().scene.camera.position - c.look_at), distance, 1e-9);
        }
        d.zoom(2);
        EXPECT_NEAR(glm::length(d.now().scene.camera.position - c.look_at), distance / 2, 1e-9);
        const auto before = d.now().scene.camera;
        d.pan(0.5, 0);
        const auto after = d.now().scene.camera;
        EXPECT_LT(glm::length((after.position - before.position) - (after.look_at - before.look_at)), 1e-12);
        // The picture's former middle is now half a picture's height to the left.
        const auto line = sight_line_at(after, 100, 100, 0, 50);
        EXPECT_LT(glm::length(glm::cross(glm::normalize(before.look_at - after.position), line.direction)), 1e-9);
    }

    TEST(document, every_step_can_be_undone_and_done_again)
    {
        document d(begun(small_cornell()));
        std::vector<version> versions{d.now()};
        const auto step = [&](const char* name, auto change) {
            d.begin(name);
            change(d.edit());
            versions.push_back(d.now());
        };
        EXPECT_EQ(d.undo(), "");
        step("k", [](version& v) { v.settings.estimate.k = 7; });
        step("lamp", [&](version& v) { move(v.scene, d.parts().back(), {0.1, 0, 0}); });
        step("backend", [](version& v) { v.backend = "cpu"; });
        d.begin("nothing"); // comes to nothing
        for (std::size_t i = versions.size() - 1; i > 0; --i) {
            EXPECT_EQ(d.undo(), i == 3 ? "backend" : i == 2 ? "lamp" : "k");
            EXPECT_EQ(d.now(), versions[i - 1]);
        }
        EXPECT_EQ(d.undo(), "");
        for (std::size_t i = 1; i < versions.size(); ++i) {
            EXPECT_NE(d.redo(), "");
            EXPECT_EQ(d.now(), versions[i]);
        }
        EXPECT_EQ(d.redo(), "");
        d.undo();
        step("another", [](version& v) { v.settings.seed = 9; });
        EXPECT_EQ(d.redo(), "") << "a new change forgets what was undone";
        for (int i = 0; i < 1000; ++i) { // its memory is bounded
            d.begin("many");
            d.edit().settings.seed = static_cast<std::uint32_t>(100 + i);
        }
        int undone = 0;
        while (!d.undo().empty())
            ++undone;
        EXPECT_EQ(undone, 200);
    }

} // namespace
} // namespace photongrid::viewer
