// Scene files after a change keep all that did not change, to the byte.
#pragma once

#include "scene_texts.hpp"

#include <photongrid/io/files.hpp>
#include <photongrid/io/json_tree.hpp>
#include <photongrid/io/scene_edit.hpp>

#include <limits>
#include <random>

namespace photongrid {
namespace {

    /// A scene as people write them: millimetres and milliwatts, comments, keys in an order of their own, kinds of
    /// shapes in turn, a channel for three, tabs.
    const std::string by_hand = R"({"$schema": "photongrid-scene.schema.json", "photongrid": 1,
 "comment": "made by hand; don't touch",
 "render": {"k": 20, "max_radius": 250, "grid": [4, 1, 4],
	"size": [64, 48], "photons": 1e3,
	"comment": "quick"},
 "units": {"power": "mW", "length": "mm"},
 "shapes": [
  {"type": "triangle", "vertices": [[0, 0, 0], [1000, 0, 0], [1000.0, 0, 1e3]], "material": "white"},
  {"material": "white", "type": "sphere", "radius": 500, "comment": "the ball", "center": [0, 1000, 0]},
  {"type": "polygon", "material": "white", "vertices": [[0, 0, 0], [1000, 0, 0], [1000, 0, 1000], [0, 0, 1000]]}],
 "materials": {"comment": "one will do", "white": {"type": "lambertian", "reflectance": 0.70}},
 "camera": {"vertical_fov": 40, "look_at": [0, 0, 0], "position": [0, 1e3, 5000]},
 "lights": [{"type": "point", "position": [0, 3000, 0], "power": 10000}]
}
)";

    /// `text` with `from`, which it holds once, replaced.
    std::string with(std::string text, const std::string& from, const std::string& to)
    {
        const auto at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        EXPECT_EQ(text.find(from, at + 1), std::string::npos) << from;
        return text.replace(at, from.size(), to);
    }

    std::string edited(const scene& s) { return edited_scene_text("s.json", by_hand, s, s.render); }

    TEST(scene_edit, changes_nothing_where_nothing_changed)
    {
        EXPECT_EQ(edited(parse_scene("s.json", by_hand)), by_hand);
        for (const auto& entry : std::filesystem::directory_iterator(scenes))
            if (entry.path().extension() == ".json"
                && entry.path().filename().string().find("schema") == std::string::npos) {
                const auto name = entry.path().string(), text = read_scene_text(name);
                const auto s = parse_scene(name, text);
                EXPECT_EQ(edited_scene_text(name, text, s, s.render), text) << name;
            }
    }

    TEST(scene_edit, keeps_automatic_what_is_automatic)
    {
        for (const auto* before : {"}", R"( "render": {}})", R"( "render": {"comment": "quick"}})",
                 R"( "render": {"k": 7, "spp": "auto"}})", R"( "render": {"photons": 1000, "grid": [4, 1, 4]}})",
                 R"( "render": {"photons": "auto", "passes": 3}})"}) {
            const auto text = good_with(before);
            const auto s = parse_scene("s.json", text);
            EXPECT_EQ(edited_scene_text("s.json", text, s, s.render), text);
            for (const auto photons : {automatic_number, 77u})
                for (const auto& [k, radius] : {std::pair(automatic_number, 3.0), std::pair(20u, automatic_length)}) {
                    auto changed = s.render;
                    changed.map.photons = photons;
                    changed.estimate.k = k;
                    changed.estimate.max_radius = radius;
                    EXPECT_EQ(parse_scene("s.json", edited_scene_text("s.json", text, s, changed)).render, changed)
                        << before << ", " << photons << ", " << k;
                }
        }
    }

    TEST(scene_edit, replaces_numbers_in_the_units_of_the_file)
    {
        auto s = parse_scene("s.json", by_hand);
        s.spheres[0].center.x += 0.125;
        s.polygons[0].vertices[2].z = 0.75; // the triangle's
        s.point_lights[0].power = dvec3(12.5);
        s.camera.vertical_fov = 35.5;
        auto expected = with(by_hand, "[0, 1000, 0]}", "[125, 1000, 0]}");
        expected = with(expected, "[1000.0, 0, 1e3]]", "[1000.0, 0, 750]]");
        expected = with(expected, "\"power\": 10000", "\"power\": 12500");
        expected = with(expected, "\"vertical_fov\": 40", "\"vertical_fov\": 35.5");
        EXPECT_EQ(edited(s), expected);
        s.point_lights[0].power = {1, 2, 3};
        EXPECT_EQ(edited(s), with(expected, "\"power\": 12500", "\"power\": [1000, 2000, 3000]"));
    }

    TEST(scene_edit, replaces_and_adds_settings)
    {
        auto s = parse_scene("s.json", by_hand);
        s.render.estimate.k = 40;
        s.render.estimate.max_radius = 0.5;
        s.render.map.grid = glm::uvec3(0);
        s.render.view.spp = 9;
        s.render.output.exposure = -1.5;
        s.render.output.only = light_part::direct; // not of files
        auto expected = with(by_hand, "\"k\": 20, \"max_radius\": 250, \"grid\": [4, 1, 4]",
            "\"k\": 40, \"max_radius\": 500, \"grid\": \"auto\"");
        expected = with(
            expected, "\"comment\": \"quick\"}", "\"comment\": \"quick\",\n\t\"spp\": 9,\n\t\"exposure\": -1.5}");
        EXPECT_EQ(edited(s), expected);
        s.camera.up = {0, 0, 1};
        EXPECT_EQ(edited(s), with(expected, "5000]}", "5000], \"up\": [0, 0, 1]}"));
    }

    TEST(scene_edit, reads_as_the_changed_scene)
    {
        // What a conversion of units cannot express exactly is off by one double at most.
        const auto near = [](double a, double b) {
            return std::abs(a - b) <= std::numeric_limits<double>::epsilon() * std::abs(b);
        };
        std::mt19937 random(11);
        std::uniform_real_distribution<double> any(-2, 2);
        for (int i = 0; i < 200; ++i) {
            auto s = parse_scene("s.json", by_hand);
            s.camera.position = {any(random), any(random), any(random)};
            const dvec3 by(any(random), any(random), any(random));
            for (auto& v : s.polygons[1].vertices)
                v += by;
            s.spheres[0].radius = std::abs(any(random)) + 1e-3;
            const auto read = parse_scene("s.json", edited(s));
            for (int c = 0; c < 3; ++c)
                EXPECT_TRUE(near(read.camera.position[c], s.camera.position[c]));
            for (std::size_t v = 0; v < 4; ++v)
                EXPECT_TRUE(near(read.polygons[1].vertices[v].x, s.polygons[1].vertices[v].x));
            EXPECT_TRUE(near(read.spheres[0].radius, s.spheres[0].radius));
        }
        // In metres and watts there is nothing to convert.
        const auto text_in_m = text(good);
        for (int i = 0; i < 200; ++i) {
            auto s = parse_scene("s.json", text_in_m);
            s.spheres[0].center = {any(random), any(random), any(random)};
            s.point_lights[0].position = {any(random), any(random), any(random)};
            s.render.estimate.max_radius = std::abs(any(random)) + 1e-3;
            EXPECT_EQ(parse_scene("s.json", edited_scene_text("s.json", text_in_m, s, s.render)), s);
        }
    }

    TEST(scene_edit, moves_meshes_where_their_place_is_written)
    {
        for (const auto& [before, after] :
            {std::pair{R"("material": "white"})", R"("material": "white", "translate": [1, 0, -0.5]})"},
                {R"("translate": [10, 0, 0.5], "material": "white"})",
                    R"("translate": [11, 0, 0], "material": "white"})"},
                {R"("matrix": [[2, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0]], "material": "white"})",
                    R"("matrix": [[2, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, -0.5]], "material": "white"})"}}) {
            const std::string triangle
                = R"({"type": "mesh", "positions": [[0, 0, 0], [9, 0, 0], [0, 9, 0]], "triangles": [[0, 1, 2]], )";
            const std::string ball = R"({"material": "white", "type": "sphere")";
            const auto text = with(by_hand, ball, triangle + before + ",\n  " + ball);
            auto s = parse_scene("s.json", text);
            s.meshes.at(0).offset += dvec3(0.001, 0, -0.0005);
            const auto changed = edited_scene_text("s.json", text, s, s.render);
            EXPECT_EQ(changed, with(by_hand, ball, triangle + after + ",\n  " + ball));
            EXPECT_LT(glm::length(parse_scene("s.json", changed).meshes.at(0).offset - s.meshes[0].offset), 1e-15);
            s.meshes[0].linear[0][0] *= 2;
            EXPECT_THROW((void)edited_scene_text("s.json", text, s, s.render), std::invalid_argument);
        }
    }

    TEST(scene_edit, moves_lights_of_meshes)
    {
        const std::string bulb = R"({"type": "point", "position")",
                          ember
            = R"({"type": "mesh_light", "power": 3, "positions": [[0, 0, 0], [9, 0, 0], [0, 9, 0]], )"
              R"("triangles": [[0, 1, 2]])";
        const auto text = with(by_hand, bulb, ember + "}, " + bulb);
        auto s = parse_scene("s.json", text);
        s.mesh_lights.at(0).surface.offset = {0, 0.25, 0};
        s.mesh_lights[0].power = dvec3(0.005);
        const auto changed = edited_scene_text("s.json", text, s, s.render);
        EXPECT_EQ(changed,
            with(with(text, "\"power\": 3,", "\"power\": 5,"), "[[0, 1, 2]]}",
                "[[0, 1, 2]], \"translate\": [0, 250, 0]}"));
        EXPECT_EQ(parse_scene("s.json", changed), s);
        s.mesh_lights[0].surface.linear[0][0] *= 2;
        EXPECT_THROW((void)edited_scene_text("s.json", text, s, s.render), std::invalid_argument);
    }

    TEST(scene_edit, refuses_other_scenes)
    {
        const auto s = parse_scene("s.json", by_hand);
        const auto refused = [](const scene& other, const std::string& word) {
            try {
                edited(other);
                return false;
            } catch (const std::invalid_argument& e) {
                return std::string(e.what()).find(word) != std::string::npos;
            }
        };
        auto other = s;
        other.spheres.push_back(other.spheres[0]);
        EXPECT_TRUE(refused(other, "sphere"));
        other = s;
        other.polygons[0].vertices.emplace_back(1, 1, 1);
        EXPECT_TRUE(refused(other, "corners"));
        other = s;
        other.materials[0].reflectance = dvec3(0.1);
        EXPECT_TRUE(refused(other, "materials"));
        other = s;
        other.point_lights[0].name = "bulb";
        EXPECT_TRUE(refused(other, "name"));
        EXPECT_THROW(edited_scene_text("s.json", "{", s, s.render), scene_error);
    }

} // namespace
} // namespace photongrid
