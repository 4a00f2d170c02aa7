// Meshes in scene files: PLY files of each format, inline ones, where they are placed, and what is refused.
#pragma once

#include "scene_texts.hpp"

#include <photongrid/io/import/mended_mesh.hpp>
#include <photongrid/io/ply_file.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>

namespace photongrid {
namespace {

    /// A value as the bytes of a binary file.
    template <class T>
    std::string bytes_of(T v, bool big)
    {
        std::string b(sizeof v, '\0');
        std::memcpy(b.data(), &v, sizeof v);
        if (big != (std::endian::native == std::endian::big))
            std::reverse(b.begin(), b.end());
        return b;
    }

    const std::vector<glm::vec3> square_positions{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0.25f, 1}};

    /// A quadrilateral and a triangle, with properties and elements that have nothing to do with them.
    std::string binary_square(bool big)
    {
        std::string b = std::string("ply\r\nformat binary_") + (big ? "big" : "little")
            + "_endian 1.0\r\ncomment made by hand\r\nelement camera 1\r\nproperty double at\r\nelement vertex 4\r\n"
              "property uchar red\r\nproperty float x\r\nproperty double y\r\nproperty float32 z\r\n"
              "property list uchar short weights\r\nelement face 2\r\nproperty int16 material\r\n"
              "property list uint8 int32 vertex_index\r\nend_header\r\n";
        b += bytes_of(0.5, big);
        for (const auto& p : square_positions) {
            b += bytes_of(std::uint8_t{200}, big) + bytes_of(p.x, big) + bytes_of(static_cast<double>(p.y), big)
                + bytes_of(p.z, big) + bytes_of(std::uint8_t{2}, big) + bytes_of(std::int16_t{-1}, big)
                + bytes_of(std::int16_t{7}, big);
        }
        const auto face = [&](const std::vector<std::int32_t>& corners) {
            b += bytes_of(std::int16_t{3}, big) + bytes_of(static_cast<std::uint8_t>(corners.size()), big);
            for (const auto c : corners)
                b += bytes_of(c, big);
        };
        face({0, 1, 2, 3});
        face({2, 1, 0});
        return b;
    }

    const std::string ascii_square = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                                     "property float z\nelement face 2\nproperty list uchar uint vertex_indices\n"
                                     "end_header\n0 0 0\n+1 -0 0.0\n1e0 0 1\n0 25e-2 1\n4 0 1 2 3\n3 2 1 0";

    std::string ply_refusal(const std::string& bytes)
    {
        return refusal_by([&] { return parse_ply("m.ply", bytes); });
    }
    std::string replaced(std::string in, const std::string& from, const std::string& to)
    {
        const auto at = in.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return in.replace(at, from.size(), to);
    }

    TEST(ply_file, every_format_gives_the_same_mesh)
    {
        const mesh expected{square_positions, {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}}};
        EXPECT_EQ(parse_ply("m.ply", ascii_square), expected);
        EXPECT_EQ(parse_ply("m.ply", binary_square(false)), expected);
        EXPECT_EQ(parse_ply("m.ply", binary_square(true)), expected);
        EXPECT_EQ(parse_ply("m.ply", replaced(ascii_square, "\n0 0 0", "\r\n0\t0 0 \r")), expected);
    }

    TEST(ply_file, normals_are_read_if_there_are_all_three)
    {
        const auto with = [](const char* names, const char* values) {
            return parse_ply("m.ply",
                std::string("ply\nformat ascii 1.0\nelement vertex 3\n") + names
                    + "property float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int "
                      "vertex_indices\nend_header\n"
                    + values + " 0 0 0\n" + values + " 1 0 0\n" + values + " 0 1 0\n3 0 1 2\n");
        };
        const auto smooth = with("property float nx\nproperty float nz\nproperty float ny\n", "1 2 3");
        EXPECT_EQ(smooth.normals, std::vector<glm::vec3>(3, {1, 3, 2}));
        EXPECT_EQ(smooth.positions[1], glm::vec3(1, 0, 0));
        EXPECT_TRUE(with("property float nx\nproperty float nz\n", "1 2").normals.empty());
    }

    TEST(ply_file, faces_may_come_before_vertices)
    {
        const auto m = parse_ply("m.ply",
            "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 3\nproperty "
            "float x\nproperty float y\nproperty float z\nend_header\n3 2 1 0\n0 0 0\n1 0 0\n0 1 0\n");
        EXPECT_EQ(m.triangles, (std::vector<glm::uvec3>{{2, 1, 0}}));
    }

    TEST(ply_file, refuses_with_the_line_or_the_byte)
    {
        struct bad {
            std::string from, to, place, what;
        };
        for (const auto& b : {bad{"ply", "plx", ":1:1", "no PLY file"}, {"ascii", "asci", ":2:1", "binary_big_endian"},
                 {"format ascii 1.0\n", "", "", "lacks a line \"format\""}, {"vertex 4", "vertex -4", ":3:1", "-4"},
                 {"vertex 4", "vertex 4000000000000", "", "more bytes"}, {"float y", "flaot y", ":5:1", "flaot"},
                 {"property float z\n", "", "", "x, y and z"}, {"vertex_indices", "corners", "", "vertex_indices"},
                 {"list uchar", "list float", ":8:1", "whole number"}, {"end_header", "end", ":9:1", "end_header"},
                 {"+1 -0", "one -0", ":11:1", "\"one\""}, {"4 0 1 2 3", "900 0 1", "", "more bytes"},
                 {"4 0 1 2 3", "4 0 1 2 4", "", "is vertex 4; there are 4"},
                 {"4 0 1 2 3", "4 0 1 2 -3", ":14:11", "whole number"},
                 {"4 0 1 2 3", "inf 0 1 2 3", ":14:4", "from 0 to 2^32 - 1"},
                 {"4 0 1 2 3", "1e30 0 1 2 3", ":14:5", "from 0 to 2^32 - 1"},
                 {"4 0 1 2 3", "4 0 1 2 1.5", ":14:12", "whole number"}}) {
            const auto said = ply_refusal(replaced(ascii_square, b.from, b.to));
            EXPECT_TRUE(said.starts_with("m.ply" + b.place)) << b.to << ": " << said;
            EXPECT_NE(said.find(b.what), std::string::npos) << b.to << ": " << said;
        }
        const auto cut = ply_refusal(binary_square(true).substr(0, binary_square(true).size() - 1));
        EXPECT_NE(cut.find("byte "), std::string::npos) << cut;
        EXPECT_NE(ply_refusal(""), "");
    }

    // Any bytes are a mesh whose indices are valid, or refused.
    TEST(ply_file, survives_damage)
    {
        for (const auto& whole : {ascii_square, binary_square(false)}) {
            for (std::size_t n = 0; n + 1 < whole.size(); ++n)
                (void)ply_refusal(whole.substr(0, n));
            std::uint32_t state = 1;
            for (int i = 0; i < 20'000; ++i) {
                mesh m;
                try {
                    m = parse_ply("m.ply", damaged(whole, {"0-9e. \nlistx\x00\xff\x7f", 15}, state));
                } catch (const scene_error&) {
                    continue;
                }
                mend(m);
                EXPECT_NO_THROW(check(m));
            }
        }
    }

    /// A folder for a test's files.
    std::filesystem::path mesh_folder()
    {
        const auto folder = std::filesystem::temp_directory_path() / "photongrid-mesh-files";
        std::filesystem::create_directories(folder / "below");
        std::ofstream(folder / "below" / "square.ply") << ascii_square;
        std::ofstream(folder / "cut.ply") << ascii_square.substr(0, ascii_square.size() - 9);
        return folder;
    }
    /// `good` with a mesh for its polygon.
    std::string text_with(const std::string& mesh)
    {
        auto lines = good;
        lines[9] = R"(  {"type": "mesh", "material": "white", )" + mesh + "}],";
        return text(lines);
    }
    const std::string inline_square = R"("positions": [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0.25, 1]],
        "triangles": [[0, 1, 2], [0, 2, 3], [2, 1, 0]])";

    TEST(mesh_in_a_scene, comes_from_a_file_or_the_scene)
    {
        const auto file = (mesh_folder() / "s.json").string();
        const auto by_file = parse_scene(file, text_with(R"("file": "below/square.ply")"));
        const auto in_line = parse_scene(file, text_with(inline_square));
        ASSERT_EQ(by_file.meshes.size(), 1u);
        ASSERT_EQ(in_line.meshes.size(), 1u);
        EXPECT_EQ(*by_file.meshes[0].surface, *in_line.meshes[0].surface);
        EXPECT_EQ(by_file.meshes[0].material, 0u);
        EXPECT_EQ(by_file.meshes[0].file, "below/square.ply");
        const auto smooth = parse_scene(
            file, text_with(inline_square + R"(, "normals": [[0, 1, 0], [0, 2, 0], [0.1, 1, 0], [1, 1, 1]])"));
        EXPECT_EQ(smooth.meshes.at(0).surface->normals[2], glm::vec3(0.1f, 1, 0));
        for (const auto& s : {by_file, in_line, smooth}) {
            const auto again = parse_scene(file, scene_text(s, s.render));
            EXPECT_TRUE(again == s) << scene_text(s, s.render);
        }
    }

    TEST(mesh_in_a_scene, is_scaled_then_rotated_then_moved_in_the_files_unit)
    {
        const auto placed = [](const std::string& how) {
            auto in_mm = text_with(inline_square + ", " + how);
            return parse_scene("s.json", replaced(in_mm, R"("length": "m")", R"("length": "mm")")).meshes.at(0);
        };
        const auto m = placed(R"("scale": [10, 20, 30], "rotate": {"axis": [0, 2, 0], "degrees": 90},
            "translate": [1, 2, 3])");
        // x to -z, z to x.
        const dvec3 p = place_of(m, {1, 1, 1}), expected{0.031, 0.022, -0.007};
        EXPECT_LT(glm::length(p - expected), 1e-15) << p.x << " " << p.y << " " << p.z;
        const auto same = placed(R"("matrix": [[0, 0, 30, 1], [0, 20, 0, 2], [-10, 0, 0, 3]])");
        EXPECT_LT(glm::length(place_of(same, {1, 1, 1}) - expected), 1e-15);
        const auto again = parse_scene("s.json",
            scene_text(
                [&] {
                    auto s = parse_scene("s.json", text_with(inline_square));
                    s.meshes[0] = m;
                    return s;
                }(),
                {}));
        EXPECT_EQ(again.meshes.at(0), m);
    }

    /// By "..", an absolute path or a link, with slashes or with backslashes, which become slashes where no file has
    /// the name with backslashes. Each would be read if it were not refused.
    TEST(mesh_in_a_scene, names_no_file_outside_of_its_folder)
    {
        const auto outside = mesh_folder(), folder = outside / "scene";
        std::filesystem::create_directories(folder / "a");
        std::ofstream(outside / "secret.ply") << ascii_square;
        std::ofstream(folder / "inside.ply") << ascii_square;
        std::filesystem::remove(folder / "link.ply");
        std::filesystem::create_symlink(outside / "secret.ply", folder / "link.ply");
        std::filesystem::remove(folder / "within.ply");
        std::filesystem::create_symlink("inside.ply", folder / "within.ply");
        const auto said = [&](std::string name) {
            for (std::size_t at = 0; (at = name.find('\\', at)) != name.npos; at += 2)
                name.insert(at, 1, '\\');
            try {
                parse_scene((folder / "s.json").string(), text_with(R"("file": ")" + name + '"'));
                return std::string();
            } catch (const scene_error& e) {
                return std::string(e.what());
            }
        };
        auto absolute = (outside / "secret.ply").string(), turned = absolute;
        std::replace(turned.begin(), turned.end(), '/', '\\');
        for (const auto& name : {std::string("../secret.ply"), std::string(R"(..\secret.ply)"),
                 std::string(R"(a\..\..\secret.ply)"), std::string("a/../../secret.ply"),
                 std::string(R"(a/..\../secret.ply)"), std::string("link.ply"), absolute, turned})
            EXPECT_NE(said(name).find("in the scene's folder"), std::string::npos) << name << ": " << said(name);
        for (const auto* name : {"inside.ply", R"(a\..\inside.ply)", "within.ply"})
            EXPECT_EQ(said(name), "") << name;
    }

    TEST(mesh_in_a_scene, is_refused_with_its_place)
    {
        const auto file = (mesh_folder() / "s.json").string();
        const auto said = [&](const std::string& mesh) {
            try {
                parse_scene(file, text_with(mesh));
                return std::string();
            } catch (const scene_error& e) {
                EXPECT_EQ(e.line, 10u) << e.what();
                return std::string(e.what());
            }
        };
        struct bad {
            std::string mesh, what;
        };
        for (const auto& b : {bad{R"("scale": 2)", "either a \"file\" or"},
                 {R"("file": "below/square.ply", "positions": [])", "either a \"file\" or"},
                 {R"("positions": [[0, 0, 0]])", "either a \"file\" or"}, {R"("file": "none.ply")", "cannot be read"},
                 {R"("file": "../s.ply")", "in the scene's folder"},
                 {R"("file": "/etc/passwd")", "in the scene's folder"}, {R"("file": "cut.ply")", "the file ends"},
                 {R"("positions": [[0, 0, 0]], "triangles": [[0, 0, 1]])", "from 0 to 0"},
                 {R"("positions": [], "triangles": [])", "at least one position"},
                 {R"("positions": [[0, 0, 0]], "triangles": [])", "at least one triangle"},
                 {R"("positions": [[0, 0, 0]], "triangles": [[0, 0, 0]], "normals": [])", "each of the 1 positions"},
                 {R"("positions": [[0, 0, 0]], "triangles": [[0, 0, 0]], "normals": [[0, 0, 0]])", "shorter"},
                 {R"("file": "below/square.ply", "normals": [])", "either a \"file\" or"},
                 {R"("file": "below/square.ply", "scale": 0)", "flat"},
                 {R"("file": "below/square.ply", "scale": [1, 0, 1])", "flat"},
                 {R"("file": "below/square.ply", "scale": 2, "matrix": [])", "either a \"matrix\" or"},
                 {R"("file": "below/square.ply", "matrix": [[1, 0, 0, 0]])", "3 rows"},
                 {R"("file": "below/square.ply", "rotate": {"axis": [0, 0, 0], "degrees": 9})", "shorter"},
                 {R"("file": "below/square.ply", "rotate": 90)", "\"axis\""}}) {
            const auto message = said(b.mesh);
            EXPECT_NE(message.find(b.what), std::string::npos) << b.mesh << ": " << message;
        }
    }

    TEST(mesh_in_a_scene, may_be_a_light)
    {
        auto lines = good;
        lines[11] = R"(  {"type": "mesh_light", "name": "ember", "power": [1, 2, 3], "translate": [0, 1, 0], )"
            + inline_square + "}],";
        const auto s = parse_scene("s.json", text(lines));
        ASSERT_EQ(s.mesh_lights.size(), 1u);
        EXPECT_EQ(s.mesh_lights[0].name, "ember");
        EXPECT_EQ(s.mesh_lights[0].power, dvec3(1, 2, 3));
        EXPECT_EQ(s.mesh_lights[0].surface.offset, dvec3(0, 1, 0));
        EXPECT_EQ(s.mesh_lights[0].surface.surface->positions, square_positions);
        EXPECT_TRUE(parse_scene("again.json", scene_text(s, s.render)) == s);
        lines[11] = R"(  {"type": "mesh_light", "power": 1, "positions": [[0, 0, 0]], "triangles": [[0, 0, 0]]}],)";
        expect_refusal(refusal(text(lines)), "12:77", {"no area"});
    }

    TEST(mesh_in_a_scene, mirrored_by_a_negative_scale_keeps_its_outside)
    {
        const auto volume = [](const placed_mesh& m) {
            double v = 0;
            for (std::size_t t = 0; t < m.surface->triangles.size(); ++t) {
                const auto c = corners_of(m, t);
                v += glm::dot(c[0], glm::cross(c[1], c[2])) / 6;
            }
            return v;
        };
        const std::string tetrahedron = R"("positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
            "triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], "scale": )";
        for (const auto* scale : {"2", "-2", "[-2, 2, 2]", "[-2, -2, 2]"})
            EXPECT_NEAR(volume(parse_scene("s.json", text_with(tetrahedron + scale)).meshes.at(0)), 8.0 / 6, 1e-12)
                << scale;
    }

} // namespace
} // namespace photongrid
