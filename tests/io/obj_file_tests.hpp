// Meshes in OBJ files.
#pragma once

#include "texture_file_tests.hpp"

#include <photongrid/io/import/mended_mesh.hpp>
#include <photongrid/io/obj_file.hpp>

#include <random>

namespace photongrid {
namespace {

    TEST(obj_file, has_faces_of_any_number_of_corners)
    {
        const auto m = parse_obj("a.obj",
            "# a comment\r\nmtllib a.mtl\r\no thing\r\nv 0 0 0\r\nv +1 0.0 0 1.0\r\nv 1 1e0 0\r\nv 0 1 -0\r\n"
            "usemtl red\r\ns off\r\nf 1 2 3 4 # a square\r\nf -4 -3 \\ \r\n  -2\r\n\r\nl 1 2\r\n");
        EXPECT_EQ(m.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
        EXPECT_EQ(m.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
        EXPECT_TRUE(m.normals.empty());
        EXPECT_TRUE(m.texture_coordinates.empty());
        EXPECT_TRUE(m.colors.empty());
    }

    TEST(obj_file, has_vertices_by_all_three_indices)
    {
        const auto m = parse_obj("a.obj",
            "f 1/1/1 2/2/1 3//1\nf 1/1/1 3//2 2\n" // before what they name
            "v 0 0 0 1 0.5 0\nv 2 0 0\nv 0 3 0 0 0 1\nvt 0.25 0.5\nvt 1\nvn 0 0 2\nvn 0 0 -1\n");
        EXPECT_EQ(m.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 3, 4}}));
        EXPECT_EQ(m.positions, (std::vector<glm::vec3>{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 3, 0}, {2, 0, 0}}));
        EXPECT_EQ(m.texture_coordinates, (std::vector<glm::vec2>{{0.25f, 0.5f}, {1, 0}, {0, 0}, {0, 0}, {0, 0}}));
        EXPECT_EQ(m.normals, (std::vector<glm::vec3>{{0, 0, 2}, {0, 0, 2}, {0, 0, 2}, {0, 0, -1}, {0, 0, -1}}))
            << "the last corner has that of its face's plane";
        EXPECT_EQ(m.colors, (std::vector<glm::vec3>{{1, 0.5f, 0}, {1, 1, 1}, {0, 0, 1}, {0, 0, 1}, {1, 1, 1}}));
        EXPECT_NO_THROW(check(m));
    }

    TEST(obj_file, that_is_wrong_is_refused_with_its_place)
    {
        const std::string head = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        struct bad {
            std::string text, place, what;
        };
        for (const auto& b :
            {bad{"v 0 abc 0\n", ":1:5:", "\"abc\""}, {"v 0 nano 0\n", ":1:5:", "\"nano\""},
                {"v 0 0\n", ":1:6:", "the end of the line"}, {"v 0 0 0 1 2\n", ":1:12:", "colour"},
                {"v 0 0 0 1 1 1 1 1\n", ":1:17:", "the end of the line"},
                {head + "f 1 2 4\n", ":4:7:", "vertex 4; there are 3"}, {head + "f 1 2 0\n", ":4:7:", "counted from 1"},
                {head + "f 1 2 -4\n", ":4:7:", "3 so far"}, {head + "f 1 2 3x\n", ":4:7:", "\"3x\""},
                {head + "f 1/1 2 3\n", ":4:5:", "texture coordinates 1"}, {head + "f 1//1 2 3\n", ":4:6:", "normal 1"},
                {head + "f 1/// 2 3\n", ":4:3:", "\"1///\""}, {head + "f 1 2 99999999999\n", ":4:7:", "99999999999"},
                {head + "face 1 2 3\n", ":4:1:", "\"face\""}, {"vt\n", ":1:3:", "texture coordinates"},
                {"vn 0 0\n", ":1:7:", "normals"}, {"v 0 \\\n x 0\n", ":2:2:", "\"x\""}}) {
            const auto message = refusal_by([&] { return parse_obj("a.obj", b.text); });
            EXPECT_NE(message.find("a.obj" + b.place), std::string::npos) << b.text << message;
            EXPECT_NE(message.find(b.what), std::string::npos) << b.text << message;
        }
        EXPECT_TRUE(parse_obj("a.obj", "").triangles.empty());
        EXPECT_NE(refusal_by([] { return read_obj("/nowhere/a.obj"); }).find("cannot be read"), std::string::npos);
    }

    // Whatever the file, the reader makes a mesh that check() takes, or refuses the file.
    TEST(obj_file, is_read_or_refused_whatever_it_holds)
    {
        const std::string good
            = "o a\nv 0 0 0\nv 1 0.5 0 1 0 1\nv 1e-3 1 0\nvt 0 1\nvn 0 1 0\nf 1/1/1 2//1 3\nf -1 -2 -3 1\n"
              "# end\n";
        const std::string bits = "0123456789.-+e/\\ \n\r#vftnaxi\t";
        std::mt19937 random(4);
        std::size_t read = 0;
        for (int i = 0; i < 20000; ++i) {
            std::string text = good;
            for (auto n = random() % 6; n > 0; --n) {
                const auto at = random() % text.size();
                const char c = bits[random() % bits.size()];
                switch (random() % 4) {
                case 0: text[at] = c; break;
                case 1: text.insert(at, 1, c); break;
                case 2: text.erase(at, 1 + random() % 4); break;
                default: text.insert(at, good.substr(random() % good.size(), random() % 12));
                }
                if (text.empty())
                    text = "f";
            }
            try {
                auto m = parse_obj("a.obj", text);
                mend(m);
                check(m);
                ++read;
            } catch (const scene_error&) {
            }
        }
        EXPECT_GT(read, 4000u);
        EXPECT_LT(read, 16000u);
    }

    TEST(obj_file, in_a_scene_is_the_mesh_that_is_listed)
    {
        const auto folder = picture_folder();
        std::ofstream(folder / "tip.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        std::ofstream(folder / "none.obj") << "v 0 0 0\n";
        const auto file = (folder / "s.json").string();
        const auto with = [&](const std::string& mesh) {
            auto lines = good;
            lines[9] = R"(  {"type": "mesh", )" + mesh + R"(, "material": "white"}],)";
            return parse_scene(file, text(lines));
        };
        const auto s = with(R"("file": "tip.obj")");
        EXPECT_TRUE(*s.meshes.at(0).surface
            == *with(R"("positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]])")
                    .meshes.at(0)
                    .surface);
        EXPECT_TRUE(parse_scene(file, scene_text(s, s.render)) == s);
        EXPECT_NE(refusal_by([&] { return with(R"("file": "none.obj")"); }).find("has no face"), std::string::npos);
    }

} // namespace
} // namespace photongrid
