// Files with one odd value, and with forms that few programs write: what can be drawn is drawn, the rest is noted.
#pragma once

#include "gltf_file_tests.hpp"
#include "pbrt_file_tests.hpp"

#include <photongrid/io/import/mended_mesh.hpp>
#include <photongrid/io/obj_file.hpp>
#include <photongrid/io/obj_scene.hpp>
#include <photongrid/io/ply_file.hpp>
#include <photongrid/scene/placed_mesh.hpp>

namespace photongrid {
namespace {

    std::string joined(const std::vector<std::string>& all)
    {
        std::string made;
        for (const auto& one : all)
            made += one + "\n";
        return made;
    }
    std::string all_notes(const imported_scene& s) { return joined(notes_of(s)); }

    double area_of(const mesh& m)
    {
        double sum = 0;
        for (std::size_t t = 0; t < m.triangles.size(); ++t) {
            const auto c = corners_of(m, t);
            sum += static_cast<double>(glm::length(glm::cross(c[1] - c[0], c[2] - c[0]))) / 2;
        }
        return sum;
    }

    const std::string three_numbers = "property float x\nproperty float y\nproperty float z\n";
    std::string ply(std::size_t vertices, const std::string& faces, const std::string& values)
    {
        return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) + "\n" + three_numbers + faces
            + "end_header\n" + values;
    }
    const std::string one_face = "element face 1\nproperty list uchar int vertex_indices\n";

    // A face need not be convex, in any format: an L of area 3, beginning at each of its corners.
    TEST(faces, that_are_concave_cover_what_they_enclose)
    {
        const std::vector<glm::vec2> outline{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
        for (std::size_t first = 0; first < outline.size(); ++first) {
            std::string vertices, lines, obj_face = "f", ply_face = "6";
            for (std::size_t i = 0; i < outline.size(); ++i) {
                const auto& p = outline[(first + i) % outline.size()];
                const auto text = std::to_string(p.x) + " " + std::to_string(p.y) + " 0\n";
                vertices += text;
                lines += "v " + text;
                obj_face += " " + std::to_string(i + 1);
                ply_face += " " + std::to_string(i);
            }
            EXPECT_NEAR(area_of(parse_obj("a.obj", lines + obj_face + "\n")), 3, 1e-6);
            EXPECT_NEAR(area_of(parse_ply("a.ply", ply(6, one_face, vertices + ply_face + "\n"))), 3, 1e-6);
        }
    }

    TEST(faces, of_fewer_than_three_corners_are_left_out_and_counted)
    {
        const auto obj
            = parse_obj_scene("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\nf 1 2 3\nusemtl b\nf 1\nf 3 2 1\n");
        EXPECT_EQ(area_of(*obj.scene.meshes.at(0).surface), 1) << "two triangles, neither of a defined material";
        EXPECT_NE(
            all_notes(obj).find("a.obj:4:1: note: 2 faces have fewer than three corners: left out"), std::string::npos)
            << all_notes(obj);
        const auto made = parse_ply_scene("a.ply",
            ply(3, "element face 3\nproperty list uchar int vertex_indices\n",
                "0 0 0\n1 0 0\n0 1 0\n2 0 1\n3 0 1 2\n0\n"));
        EXPECT_EQ(made.scene.meshes.at(0).surface->triangles.size(), 1u);
        EXPECT_NE(all_notes(made).find("2 faces have fewer than three corners: left out"), std::string::npos)
            << all_notes(made);
    }

    // Stanford's scans.
    TEST(ply_file, strips_of_triangles_are_read)
    {
        const auto m = parse_ply("a.ply",
            ply(6, "element tristrips 1\nproperty list int int vertex_indices\n",
                "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n11 0 1 2 3 3 -1 2 3 4 5 5\n"));
        EXPECT_EQ(m.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}}));
        for (std::size_t t = 0; t < m.triangles.size(); ++t) {
            const auto c = corners_of(m, t);
            EXPECT_GT(glm::cross(c[1] - c[0], c[2] - c[0]).z, 0) << "all show the same side";
        }
        EXPECT_NE(refusal_by([] {
            return parse_ply(
                "a.ply", ply(1, "element tristrips 1\nproperty list int int vertex_indices\n", "0 0 0\n1 -2\n"));
        }).find("neither -1"),
            std::string::npos);
    }

    TEST(ply_file, lines_end_as_on_any_system)
    {
        const auto text = ply(3, one_face, "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
        const auto expected = parse_ply("a.ply", text);
        for (const std::string end : {"\r", "\r\n"}) {
            std::string other;
            for (const char c : text)
                other += c == '\n' ? end : std::string(1, c);
            EXPECT_EQ(parse_ply("a.ply", other), expected);
            EXPECT_EQ(parse_ply_scene("a.ply", other).scene.meshes.size(), 1u);
        }
        // Binary numbers begin right after the last line, whatever byte they begin with.
        for (const std::string end : {"\r", "\r\n", "\n"}) {
            std::string bytes;
            for (const char c :
                "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + three_numbers + one_face + "end_header\n")
                bytes += c == '\n' ? end : std::string(1, c);
            const float odd = std::bit_cast<float>(0x3F80000Au); // its first byte is a line feed
            for (const float f : {odd, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}) {
                char b[4];
                std::memcpy(b, &f, 4);
                bytes.append(b, 4);
            }
            bytes += std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
            EXPECT_EQ(parse_ply("a.ply", bytes).positions.at(0), glm::vec3(odd, 0, 0));
        }
        // Lines are counted as they end.
        EXPECT_NE(refusal_by([] { return parse_ply("a.ply", "ply\rformat ascii 1.0\rfoo\r"); }).find(":3:1"),
            std::string::npos);
    }

    TEST(vertices, that_are_no_number_cost_their_faces_alone)
    {
        for (const auto* odd : {"nan", "-nan(ind)", "inf", "1e400", "1e30"}) {
            const auto made = parse_obj_scene(
                "a.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 ") + odd + " 0\nf 1 2 3\nf 1 2 4\n");
            EXPECT_EQ(made.scene.meshes.at(0).surface->triangles.size(), 1u) << odd;
            EXPECT_NE(all_notes(made).find("1 triangle has a vertex that is not finite"), std::string::npos)
                << all_notes(made);
            EXPECT_NO_THROW(check(made.scene)) << odd;
        }
        // What no face uses does not matter.
        const auto unused = parse_obj_scene("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan nan nan\nf 1 2 3\n");
        EXPECT_EQ(all_notes(unused).find("not finite"), std::string::npos) << all_notes(unused);
        // Texture coordinates and normals are replaced.
        const auto coordinates
            = parse_obj_scene("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt nan 1\nvn 0 0 inf\nf 1/1/1 2/1/1 3/1/1\n");
        EXPECT_NE(all_notes(coordinates).find("of vertices out of range"), std::string::npos) << all_notes(coordinates);
        EXPECT_EQ(coordinates.scene.meshes.at(0).surface->texture_coordinates.at(0), glm::vec2(0));
        EXPECT_NO_THROW(check(coordinates.scene));
        const auto floats = parse_ply_scene("a.ply",
            ply(4, "element face 2\nproperty list uchar int vertex_indices\n",
                "0 0 0\n1 0 0\n0 1 0\n0 nan 0\n3 0 1 2\n4 0 1 2 3\n"));
        EXPECT_EQ(floats.scene.meshes.at(0).surface->triangles.size(), 2u) << "of the second face half is left";
        const auto colours = parse_obj_scene("a.obj", "v 0 0 0 2 0 -1\nv 1 0 0 1 1 1\nv 0 1 0 1 nan 1\nf 1 2 3\n");
        EXPECT_EQ(
            colours.scene.meshes.at(0).surface->colors, (std::vector<glm::vec3>{{1, 0, 0}, {1, 1, 1}, {1, 0, 1}}));
        // A scene of nothing else has no shape.
        EXPECT_NE(refusal_by([] {
            return parse_obj_scene("a.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").scene;
        }).find("no shape that can be drawn"),
            std::string::npos);
        // Words that are no numbers are still refused.
        EXPECT_NE(refusal_by([] { return parse_obj("a.obj", "v 0 none 0\n"); }).find("\"none\""), std::string::npos);
    }

    /// A glTF file of a square with the node's other properties, below a node with those of its parent.
    imported_scene square_of(const std::string& node, const std::string& parent = "", const std::string& material = "",
        const std::string& generator = "hand", const import_settings& settings = {})
    {
        gltf_text file;
        const auto at = file.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0});
        auto text = file.text(R"("extensionsUsed": ["KHR_node_visibility"], "scene": 0, "scenes": [{"nodes": [1, 2]}],)"
                              R"("meshes": [{"primitives": [{"attributes": {"POSITION": )"
            + std::to_string(at) + R"(}, "material": 0}]}], "materials": [{"doubleSided": true)" + material
            + R"(}], "nodes": [{"mesh": 0)" + node + R"(}, {"children": [0])" + parent
            + R"(}, {"mesh": 0, "translation": [5, 0, 0]}])");
        const std::string plain = R"({"version": "2.0"})";
        text.replace(text.find(plain), plain.size(), R"({"version": "2.0", "generator": ")" + generator + "\"}");
        return parse_gltf("s.gltf", text, settings);
    }

    TEST(gltf_file, nodes_that_are_hidden_are_not_drawn)
    {
        EXPECT_EQ(square_of("").scene.meshes.size(), 2u);
        const std::string hidden = R"(, "extensions": {"KHR_node_visibility": {"visible": false}})";
        EXPECT_EQ(square_of(hidden).scene.meshes.size(), 1u);
        EXPECT_EQ(square_of("", hidden).scene.meshes.size(), 1u) << "with all that is below";
        EXPECT_EQ(square_of(R"(, "extensions": {"KHR_node_visibility": {"visible": true}})").scene.meshes.size(), 2u);
        EXPECT_EQ(all_notes(square_of("")).find("KHR_node_visibility"), std::string::npos);
    }

    TEST(gltf_file, a_scale_of_0_hides_or_flattens)
    {
        const auto hidden = square_of(R"(, "scale": [0, 0, 0])");
        EXPECT_EQ(hidden.scene.meshes.size(), 1u);
        EXPECT_NE(all_notes(hidden).find("leaves nothing of this shape"), std::string::npos) << all_notes(hidden);
        EXPECT_EQ(square_of(R"(, "scale": [0, 2, 1])").scene.meshes.size(), 1u) << "it is a line";
        // Along its normal a square may be scaled by 0.
        const auto flat = square_of(R"(, "scale": [2, 3, 0], "translation": [0, 0, 7])");
        ASSERT_EQ(flat.scene.meshes.size(), 2u);
        EXPECT_NEAR(area_of(flat.scene.meshes[0]), 6, 1e-6);
        EXPECT_NEAR(place_of(flat.scene.meshes[0], flat.scene.meshes[0].surface->positions[2]).z, 7, 1e-6);
        const auto matrix = square_of(R"(, "matrix": [1,0,0,0, 0,1,0,0, 1,1,0,0, 0,0,0,1])");
        EXPECT_NEAR(area_of(matrix.scene.meshes.at(0)), 1, 1e-6);
    }

    // glTF has nits; Blender writes watts.
    TEST(gltf_file, emission_is_in_the_unit_that_its_writer_means)
    {
        const std::string lit = R"(, "emissiveFactor": [1, 1, 1])", blender = "Khronos glTF Blender I/O v3.4.50";
        using unit = import_settings::emission;
        const auto power = [&](const std::string& generator, std::optional<unit> asked) {
            const auto s = square_of("", "", lit, generator, {.emission_unit = asked}).scene;
            return s.mesh_lights.empty() ? s.rectangle_lights.at(0).power.x : s.mesh_lights.at(0).power.x;
        };
        const double nits = power("hand", {}), watts = power(blender, {});
        EXPECT_NEAR(watts / nits, 683, 1e-9);
        EXPECT_EQ(power(blender, unit::nits), nits);
        EXPECT_EQ(power("hand", unit::watts), watts);
    }

    // Blender writes glass without a volume. A closed mesh of it is a body, an open one a pane.
    TEST(gltf_file, closed_meshes_that_transmit_are_bodies_of_glass)
    {
        gltf_text file;
        const auto open = file.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
        const auto corners = file.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
        const auto indices
            = file.add(12, "SCALAR", 5121, bytes_of<unsigned char>({0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3}));
        const auto kinds = [&](const std::string& volume) {
            const auto made = parse_gltf("s.gltf",
                file.text(
                    R"("materials": [{"name": "glass", "pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {"KHR_materials_transmission": )"
                    R"({"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.4})"
                    + volume + R"(}}], "meshes": [{"primitives": [{"material": 0, "attributes": {"POSITION": )"
                    + std::to_string(open) + R"(}}, {"material": 0, "attributes": {"POSITION": )"
                    + std::to_string(corners) + R"(}, "indices": )" + std::to_string(indices)
                    + R"(}]}], "nodes": [{"mesh": 0}])"));
            std::vector<material_kind> all;
            for (const auto& m : made.scene.meshes) {
                all.push_back(made.scene.materials[m.material].kind);
                EXPECT_EQ(made.scene.materials[m.material].index_of_refraction, 1.4);
            }
            EXPECT_EQ(all_notes(made).find("drawn as bodies of glass") != std::string::npos, volume.empty());
            return all;
        };
        const std::vector<material_kind> expected{material_kind::thin_glass, material_kind::glass};
        EXPECT_EQ(kinds(""), expected);
        EXPECT_EQ(kinds(R"(, "KHR_materials_volume": {"thicknessFactor": 1})"),
            std::vector<material_kind>(2, material_kind::glass));
    }

    class odd_files : public import_folder {};

    // The same picture behind the same scene: Blender has its middle at x.
    TEST_F(odd_files, an_environment_stands_where_the_scenes_writer_has_it)
    {
        image sky{.width = 4, .height = 1, .pixels = {{1, 1, 1}, {1, 1, 1}, {9, 1, 1}, {1, 1, 1}}};
        write_image((folder / "sky.pfm").string(), sky);
        gltf_text file;
        const auto at = file.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
        const auto text = file.text(R"("meshes": [{"primitives": [{"attributes": {"POSITION": )" + std::to_string(at)
            + R"(}}]}], "nodes": [{"mesh": 0}])");
        const std::string plain = R"({"version": "2.0"})";
        auto by_blender = text;
        by_blender.replace(
            text.find(plain), plain.size(), R"({"generator": "Khronos glTF Blender I/O v1", "version": "2.0"})");
        write("hand.gltf", text);
        write("blender.gltf", by_blender);
        const auto turned = [&](const char* name, std::optional<double> degrees) {
            const auto s = import_scene((folder / name).string(),
                {.environment = (folder / "sky.pfm").string(), .environment_rotate = degrees});
            return s.scene.environment_lights.at(0).degrees;
        };
        EXPECT_EQ(turned("hand.gltf", {}), 0);
        EXPECT_EQ(turned("blender.gltf", {}), 90);
        EXPECT_EQ(turned("blender.gltf", 0), 0);
        EXPECT_EQ(turned("hand.gltf", -30), -30);
        // Turned so, the middle of a map, which is at z, is at x.
        const auto to_x = rotation_about(dvec3(0, 1, 0), 90) * environment_direction(0.5, 0.5);
        expect_near(to_x, dvec3(1, 0, 0), 1e-12);
    }

    // pbrt-v3's words for what pbrt-v4 has, too.
    TEST(pbrt_file, of_version_3_is_read_as_version_4_would_say_it)
    {
        const auto same = [](const std::string& old, const std::string& now) {
            auto a = pbrt_world(old + ball).materials, b = pbrt_world(now + ball).materials;
            ASSERT_EQ(a.size(), b.size()) << old;
            for (std::size_t m = 0; m < a.size(); ++m) {
                a[m].name = b[m].name;
                EXPECT_EQ(a[m], b[m]) << old;
            }
        };
        same("Material \"matte\" \"rgb Kd\" [.5 .2 .1]\n", "Material \"diffuse\" \"rgb reflectance\" [.5 .2 .1]\n");
        same("Material \"matte\" \"color Kd\" [.5 .2 .1]\n", "Material \"diffuse\" \"rgb reflectance\" [.5 .2 .1]\n");
        same("Material \"plastic\" \"rgb Kd\" [.5 .2 .1]\n",
            "Material \"coateddiffuse\" \"rgb reflectance\" [.5 .2 .1] \"float roughness\" .1\n");
        same("Material \"mirror\"\n", "Material \"conductor\" \"rgb reflectance\" [.9 .9 .9]\n");
        same("Material \"glass\" \"float index\" 1.4\n", "Material \"dielectric\" \"float eta\" 1.4\n");
        same("MakeNamedMaterial \"a\" \"string type\" \"matte\" \"rgb Kd\" [.5 .2 .1]\nNamedMaterial \"a\"\n",
            "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [.5 .2 .1]\nNamedMaterial "
            "\"a\"\n");
        const std::string both = "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [1 0 0]\n"
                                 "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"rgb reflectance\" [0 1 0]\n";
        same(both
                + "Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\" \"rgb amount\" "
                  "[.25 .25 .25]\n",
            both + "Material \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" .75\n");
        const auto notes
            = all_notes(pbrt_scene("Material \"uber\" \"rgb Kd\" [.5 .2 .1] \"rgb Ks\" [.1 .1 .1]\n" + ball));
        EXPECT_NE(notes.find("written for pbrt-v3"), std::string::npos) << notes;
        EXPECT_NE(notes.find("\"rgb Ks\" is left out"), std::string::npos) << notes;
        const auto lit = pbrt_world(ball + "LightSource \"infinite\" \"rgb L\" [1 2 3] \"rgb scale\" [2 2 1]\n");
        EXPECT_EQ(lit.environment_lights.at(0).radiance, dvec3(2, 4, 3));
        EXPECT_NE(
            refusal_by([] { return pbrt_world("Material \"matte\" \"xyz Kd\" [1 1 1]\n" + ball); }).find("--upgrade"),
            std::string::npos);
    }

    // Its environments are by longitude and latitude, with the left edge at x and z up.
    TEST_F(odd_files, an_environment_of_pbrt_3_stands_where_pbrt_3_has_it)
    {
        image sky{.width = 4, .height = 2, .pixels = std::vector<glm::vec3>(8, glm::vec3(1))};
        write_image((folder / "sky.pfm").string(), sky);
        write("s.pbrt",
            "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\" \"string mapname\" \"sky.pfm\"\n" + ball);
        const auto s = import_scene((folder / "s.pbrt").string()).scene;
        const auto& l = s.environment_lights.at(0);
        const auto turn = rotation_about(l.axis, l.degrees);
        // The file's z is reversed, since its camera is left-handed.
        for (const double u : {0.0, 0.25, 0.6})
            for (const double v : {0.1, 0.5}) {
                const double phi = 2 * std::numbers::pi * u, theta = std::numbers::pi * v;
                const dvec3 there(std::cos(phi) * std::sin(theta), std::sin(phi) * std::sin(theta), -std::cos(theta));
                expect_near(turn * environment_direction(u, v), there, 1e-9);
            }
    }

} // namespace
} // namespace photongrid
