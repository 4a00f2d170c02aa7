// OBJ files with their MTL files, and PLY files, as scenes: what materials become, which triangles have which, what is
// noted and what is refused.
#pragma once

#include "pbrt_file_tests.hpp"

#include <photongrid/io/import/coat.hpp>
#include <photongrid/io/obj/mtl.hpp>
#include <photongrid/io/obj_scene.hpp>

namespace photongrid {
namespace {

    const std::string corners_of_a_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    const std::string square_with_coordinates = corners_of_a_square + "f 1/1 2/2 3/3 4/4\n";

    /// A folder with files, which ends with the test.
    class obj_folder : public import_folder {
    protected:
        imported_scene read(const std::string& text, const import_settings& settings = {})
        {
            write("s.obj", text);
            return import_scene((folder / "s.obj").string(), settings);
        }
        /// What is said without the folder: the refusal, or the notes but those on the camera and the light.
        std::vector<std::string> said(const std::string& text, const import_settings& settings = {})
        {
            std::vector<std::string> all;
            const auto refused = refusal_by([&] {
                auto made = read(text, settings);
                all = notes_of(made);
                return made;
            });
            std::erase_if(all, [](const std::string& n) { return n.find("is added") != std::string::npos; });
            if (!refused.empty())
                all = {refused};
            for (auto& n : all)
                for (auto at = n.find(folder.string()); at != std::string::npos; at = n.find(folder.string()))
                    n.erase(at, folder.string().size() + 1);
            return all;
        }
        /// The scene of a square with this material, beside one that is diffuse.
        imported_scene with_material(const std::string& keys)
        {
            write("m.mtl", "newmtl a\n" + keys + "newmtl other\nKd 0.5 0.5 0.5\n");
            return read("mtllib m.mtl\nusemtl a\n" + square_with_coordinates + "usemtl other\nf 1 2 3\n");
        }
        std::vector<std::string> said_of_material(const std::string& keys)
        {
            write("m.mtl", "newmtl a\n" + keys + "newmtl other\nKd 0.5 0.5 0.5\n");
            return said("mtllib m.mtl\nusemtl a\n" + square_with_coordinates + "usemtl other\nf 1 2 3\n");
        }
        /// A picture of 2 x 2 pixels of red, green, blue and alpha, row by row from the top left.
        void write_picture(const std::string& name, const std::array<std::array<unsigned char, 4>, 4>& pixels)
        {
            std::string tga{0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 32, 0x28}; // from the top, 8 bits of alpha
            for (const auto& p : pixels)
                for (const int c : {2, 1, 0, 3})
                    tga += static_cast<char>(p[static_cast<std::size_t>(c)]);
            write(name, tga);
        }
    };

    const material& first_material(const imported_scene& s)
    {
        return s.scene.materials.at(s.scene.meshes.at(0).material);
    }

    // As many meshes as materials in use, whatever the groups; vertices are shared within each alone.
    TEST_F(obj_folder, has_a_mesh_for_each_material)
    {
        write("colours of it.mtl", "newmtl red\nKd 1 0 0\nnewmtl unused\nKd 1\nnewmtl blue one\nKd 0 0 1\n");
        const auto s = read("mtllib colours of it.mtl\n" + corners_of_a_square
            + "g first\nusemtl red\nf 1 2 3\nusemtl blue one  \nf 1/1 3/3 4/4\ng second\nusemtl red\nf 1 3 4\nusemtl "
              "blue one # again\nf 2 3 4\n")
                           .scene;
        ASSERT_EQ(s.meshes.size(), 2u);
        ASSERT_EQ(s.materials.size(), 2u);
        const auto& red = *s.meshes[0].surface;
        EXPECT_EQ(s.materials[s.meshes[0].material].name, "red");
        EXPECT_EQ(s.materials[s.meshes[0].material].reflectance, dvec3(1, 0, 0));
        EXPECT_EQ(red.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
        EXPECT_EQ(red.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
        EXPECT_TRUE(red.texture_coordinates.empty());
        const auto& blue = *s.meshes[1].surface;
        EXPECT_EQ(s.materials[s.meshes[1].material].name, "blue one");
        EXPECT_EQ(
            blue.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
        EXPECT_EQ(blue.texture_coordinates[1], glm::vec2(1, 1));
        EXPECT_TRUE(said("mtllib colours of it.mtl\n" + square_with_coordinates, {.strict = true}).empty());
    }

    TEST_F(obj_folder, materials_become_photongrids)
    {
        struct material_case {
            const char* keys;
            material_kind kind;
            dvec3 reflectance;
            double index, roughness, opacity;
        };
        const auto of_exponent = [](double ns) { return std::sqrt(std::sqrt(2 / (ns + 2))); }; // of alpha
        using enum material_kind;
        const material_case cases[] = {
            {"", lambertian, dvec3(0.5), 1.5, 0, 1},
            {"Kd 0.1 0.2 0.3\nKa 1 1 1\nKe 0 0 0\n", lambertian, {0.1, 0.2, 0.3}, 1.5, 0, 1},
            {"Kd 0.25\nKs 0.5 0.5 0.5\nNs 100\nillum 1\n", lambertian, dvec3(0.25), 1.5, 0, 1},
            {"Kd 1 1 1\nKs 1 1 1\nNs 0\nillum 2\nTr 0\n", lambertian, dvec3(1), 1.5, 0, 1}, // MeshLab
            {"Ns 250\nKa 1 1 1\nKd 0.8 0.8 0.8\nKs 0.5 0.5 0.5\nKe 0 0 0\nNi 1.45\nd 1\nillum 2\n", plastic, dvec3(0.8),
                1.45, of_exponent(250), 1},                                                             // Blender
            {"illum 4\nKd 0.5 0.5 0.5\nKa 0 0 0\nTf 1 1 1\nNi 1\n", lambertian, dvec3(0.5), 1.5, 0, 1}, // Maya
            {"illum 4\nKd 0.5 0.5 0.5\nTf 1 1 1\nNi 1\nKs 0.5 0.5 0.5\nNs 18\n", plastic, dvec3(0.5), 1.5,
                of_exponent(18), 1},
            {"Ns 1000\nKd 0.8 0.8 0.8\nKs 0.5 0.5 0.5\nNi 1.45\nd 0.25\nillum 9\n", plastic, dvec3(0.8), 1.45, 0, 0.25},
            {"Kd 1 0 0\nTr 0.75\n", lambertian, {1, 0, 0}, 1.5, 0, 0.25},
            {"Kd 0 0 0\nKs 0.9 0.8 0.7\nillum 3\n", metal, {0.9, 0.8, 0.7}, 1.5, 0, 1},
            {"Kd 0 0 0\nKs 0.9 0.8 0.7\nNs 30\nillum 5\n", metal, {0.9, 0.8, 0.7}, 1.5, of_exponent(30), 1},
            {"Kd 0 0 0\nTf 0.9 1 0.8\nNi 1.6\nillum 7\n", glass, {0.9, 1, 0.8}, 1.6, 0, 1},
            {"Kd 0.01 0.01 0.01\nKs 0.01\nillum 6\nd 0.1\n", glass, dvec3(1), 1.5, 0, 1},
            {"Kd 0 0 0\nKs 1 1 1\nNi 1.3\nillum 4\n", glass, dvec3(1), 1.3, 0, 1},
            {"Kd 0.9 0.8 0.1\nPm 1\nPr 0.25\nNs 200\nKs 0.5\nillum 3\n", metal, {0.9, 0.8, 0.1}, 1.5, 0.25, 1},
            {"Kd 0.9 0.8 0.1\nPm 0\nPr 0.25\nPs 0\nPc 0\nPcr 0.03\naniso 0\nanisor 0\nNi 1.4\n", plastic,
                {0.9, 0.8, 0.1}, 1.4, 0.25, 1},
        };
        for (const auto& c : cases) {
            const auto made = with_material(c.keys);
            const auto& m = first_material(made);
            const bool is_sheet = c.kind == glass; // since the triangle has no inside
            EXPECT_EQ(m.kind, is_sheet ? thin_glass : c.kind) << c.keys;
            auto seen = m;
            if (m.kind == plastic)
                set_reflectance_above_coat(seen); // Kd is what leaves the coat
            expect_near(seen.reflectance, c.reflectance, 1e-9);
            EXPECT_EQ(m.index_of_refraction, c.index) << c.keys;
            EXPECT_NEAR(m.roughness, c.roughness, 1e-12) << c.keys;
            EXPECT_EQ(m.opacity, c.opacity) << c.keys;
            EXPECT_EQ(made.notes.size(), is_sheet ? 3u : 2u) // on the camera and the light
                << c.keys << text_of(made.notes.at(0));
        }
    }

    // MTL: illumination model 3 adds what a mirror reflects, Ks of it, to the diffuse light.
    TEST_F(obj_folder, mirrors_with_a_diffuse_colour_are_mixtures)
    {
        const auto made = with_material("Kd 0.3 0.2 0.1\nKs 0.5 0.4 0.25\nillum 3\nd 0.5\n").scene;
        const auto& m = made.materials.at(made.meshes.at(0).material);
        ASSERT_EQ(m.kind, material_kind::mixture);
        const auto &below = made.materials.at(m.parts[0]), &above = made.materials.at(m.parts[1]);
        EXPECT_EQ(above.kind, material_kind::metal);
        expect_near((1 - m.share) * below.reflectance, {0.3, 0.2, 0.1});
        expect_near(m.share * above.reflectance, {0.5, 0.4, 0.25});
        EXPECT_EQ(m.opacity, 0.5);
        const auto partly = with_material("Kd 0.3 0.2 0.1\nPm 0.25\nPr 1\n").scene;
        const auto& p = partly.materials.at(partly.meshes.at(0).material);
        ASSERT_EQ(p.kind, material_kind::mixture);
        EXPECT_EQ(p.share, 0.25);
        EXPECT_EQ(partly.materials.at(p.parts[1]).kind, material_kind::metal);
        EXPECT_EQ(partly.materials.at(p.parts[0]).kind, material_kind::plastic);
    }

    // The radiance of lamps is Ke, on the side from which their corners run counterclockwise.
    TEST_F(obj_folder, surfaces_with_Ke_are_lamps)
    {
        write("m.mtl", "newmtl lamp\nKe 5 6 7\nKd 0 0 0\nnewmtl floor\nKd 0.5\n");
        const auto made = read("mtllib m.mtl\nusemtl lamp\nv 0 3 0\nv 0 3 1\nv 2 3 1\nv 2 3 0\nf 4 3 2 1\nusemtl "
                               "floor\nv 0 0 0\nv 0 0 1\nv 1 0 0\nf 5 6 7\n");
        const auto& l = made.scene.rectangle_lights.at(0);
        expect_near(l.power, dvec3(5, 6, 7) * (2 * std::numbers::pi), 1e-9);
        expect_near(glm::normalize(glm::cross(l.edge_u, l.edge_v)), {0, -1, 0});
        EXPECT_TRUE(made.scene.environment_lights.empty());
        EXPECT_EQ(made.scene.meshes.size(), 1u);
        const auto in_cm = read(
            "mtllib m.mtl\nusemtl lamp\nv 0 3 0\nv 0 3 1\nv 2 3 1\nf 1 2 3\nusemtl floor\nf 1 2 3\n", {.unit = 0.01});
        expect_near(in_cm.scene.mesh_lights.at(0).power, dvec3(5, 6, 7) * (1e-4 * std::numbers::pi), 1e-12);
    }

    // (0, 0) is the lower left corner of a picture in OBJ files, as in photongrid; its first row is at the top.
    TEST_F(obj_folder, pictures_lie_as_in_the_file)
    {
        write_picture("below/a b.tga", {{{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 51}}});
        const auto made = with_material("Kd 0.5 0.5 0.5\nmap_Kd -s 2 3 -o 0.5 -clamp on -bm 1 below\\a b.tga\nmap_d "
                                        "\"below/a b.tga\"\nmap_Ka no.png\n");
        const auto& m = first_material(made);
        ASSERT_TRUE(m.texture.map);
        EXPECT_EQ(m.reflectance, dvec3(0.5));
        EXPECT_EQ(m.texture.map->texels[0], glm::u16vec4(65535, 0, 0, 65535)); // upper left
        EXPECT_EQ(m.texture.map->texels[2], glm::u16vec4(0, 0, 65535, 65535)); // lower left
        EXPECT_EQ(m.texture.scale, glm::dvec2(2, 3));
        EXPECT_EQ(m.texture.offset, glm::dvec2(0.5, 0));
        EXPECT_EQ(m.texture.wrap, texture_wrap::clamp);
        const auto& square = *made.scene.meshes[0].surface;
        for (std::size_t v = 0; v < 4; ++v) // u and v are x and y, so that the upper left corner is at (0, 1)
            EXPECT_EQ(square.texture_coordinates[v], glm::vec2(square.positions[v]));
        ASSERT_TRUE(m.opacity_texture.map);
        EXPECT_EQ(m.opacity_texture.channel, texture_channel::alpha);
        EXPECT_EQ(m.opacity_texture.map->texels[3].w, 51 * 257);
        EXPECT_EQ(made.notes.size(), 2u);

        write_picture("mask.tga", {{{255, 0, 0, 255}, {0, 0, 0, 255}, {0, 0, 0, 255}, {51, 0, 0, 255}}});
        EXPECT_EQ(first_material(with_material("map_d mask.tga\n")).opacity_texture.channel, texture_channel::red);
        EXPECT_EQ(first_material(with_material("map_d -imfchan g mask.tga\n")).opacity_texture.channel,
            texture_channel::green);
        const auto rough = with_material("Pm 1\nmap_Pr mask.tga\nmap_Kd mask.tga\n");
        EXPECT_TRUE(first_material(rough).roughness_texture.map);
        EXPECT_EQ(first_material(rough).roughness, 1);
        EXPECT_EQ(first_material(rough).reflectance, dvec3(1));
        const auto metallic = with_material("map_Pm mask.tga\nPr 0.5\n");
        EXPECT_EQ(first_material(metallic).kind, material_kind::mixture);
        EXPECT_TRUE(first_material(metallic).share_texture.map);
        // 255 and 51 are 1 and, by the curve of sRGB, 0.0331.
        write("m.mtl", "newmtl a\nmap_Ke mask.tga\nKd 0 0 0\nKe 10\n");
        const auto lit = read("mtllib m.mtl\n" + corners_of_a_square + "f 1 2 3\nusemtl a\nf 1 2 3 4\n");
        EXPECT_NEAR(lit.scene.rectangle_lights.at(0).power.x, 10 * 1.0331 / 4 * std::numbers::pi, 1e-3);
    }

    TEST_F(obj_folder, what_is_replaced_or_left_out_is_noted_with_its_place)
    {
        struct note_case {
            const char *keys, *note;
        };
        const note_case cases[] = {
            {"Kd 2 1 1\n", "m.mtl:1:1: note: material \"a\": Kd is limited to 0 to 1"},
            {"Kd spectral a.rfl\n", "m.mtl:2:1: note: Kd: a file of a spectrum is left out"},
            {"  map_Bump -bm 2 a b.png\n", "m.mtl:2:3: note: \"map_Bump\" is left out"},
            {"refl -type sphere x.png\n", "m.mtl:2:1: note: \"refl\" is left out"},
            {"Km 0.5\n", "m.mtl:2:1: note: \"Km\" is left out"},
            {"Pc 0.5\n", "m.mtl:2:1: note: Pc is left out"},
            {"d -halo 0.5\n", "m.mtl:2:3: note: -halo is left out: the surface is as opaque from all directions"},
            {"illum 11\n", "m.mtl:2:1: note: there is no such illumination model; 2 is used"},
            {"Tr 1\n",
                "m.mtl:1:1: note: material \"a\": Tr 1 is taken for opaque, since programs that write it without d "
                "mean "
                "that"},
            {"d 0.5\nTr 0.1\n", "m.mtl:1:1: note: material \"a\": d and Tr differ; d is used"},
            {"Tf 0.2 0.2 0.2\nillum 4\n", "m.mtl:1:1: note: material \"a\": Tf is left out: it colours glass alone"},
            {"Kd 1\nillum 7\n", "m.mtl:1:1: note: material \"a\": glass, without its diffuse colour"},
            {"Kd 0.8\nKs 0.5\nillum 3\n",
                "m.mtl:1:1: note: material \"a\": Kd and Ks are more than 1 together; Kd is limited"},
            {"Ks 1 0 0\nNs 9\n", "m.mtl:1:1: note: material \"a\": its highlight has no colour: a clear coat is drawn"},
            {"map_Kd no.png\n",
                "m.mtl:2:1: note: a picture is left out: no.png: cannot be read: No such file or directory"},
            {"map_Kd\n", "m.mtl:2:1: note: a picture without a file is left out"},
            {"map_Kd -t 1 no.png\n", "m.mtl:2:8: note: the turbulence of a picture is left out"},
            {"map_Ke x.png\nKe 0\n", "m.mtl:2:1: note: the picture of what a surface emits is left out: Ke is 0"},
            {"Ke 1\nKd 0.5\n", "m.mtl:1:1: note: the surface of a lamp: black; its material is left out"},
            {"newmtl a\n", "m.mtl:2:1: note: material \"a\" is defined before; this one is left out"},
        };
        for (const auto& c : cases) {
            const auto notes = said_of_material(c.keys);
            EXPECT_TRUE(std::find(notes.begin(), notes.end(), c.note) != notes.end())
                << c.note << "\n"
                << (notes.empty() ? "(none)" : notes[0]);
        }
        const note_case in_obj[] = {
            {"usemtl b\nf 1 2 3\n", "s.obj:10:1: note: the material \"b\" is not defined: drawn as diffuse 0.5"},
            {"l 1 2\nl 2 3\nf 1 2 3\n", "s.obj:10:1: note: \"l\" is left out, here and 1 times more"},
            {"s 1\nf 1 2 3\n", "s.obj:10:1: note: smoothing is left out: faces without normals look flat"},
            {"mtllib no.mtl m.mtl\nf 1 2 3\n",
                "s.obj:10:1: note: a file of materials is left out: no.mtl: cannot be read: No such file or directory"},
        };
        write("m.mtl", "newmtl a\n");
        for (const auto& c : in_obj) {
            const auto notes = said("mtllib m.mtl\n" + corners_of_a_square + c.keys);
            EXPECT_EQ(notes, std::vector<std::string>{c.note});
            EXPECT_TRUE(said("mtllib m.mtl\n" + corners_of_a_square + c.keys, {.strict = true})
                            .at(0)
                            .ends_with("(refused, since nothing may be replaced or left out)"));
        }
        EXPECT_EQ(said("usemtl a\n" + square_with_coordinates + "usemtl b\nf 1 2 3\n"),
            std::vector<std::string>{"s.obj:1:1: note: no material is defined: all are drawn as diffuse 0.5"});
        EXPECT_EQ(said("mtllib m.mtl\ns off\n" + square_with_coordinates), std::vector<std::string>{});
        write("m.mtl", "newmtl a\nmap_Kd a.png\n");
        EXPECT_EQ(said("mtllib m.mtl\nusemtl a\n" + corners_of_a_square + "f 1 2 3\n"),
            std::vector<std::string>{"m.mtl:2:1: note: a picture is left out: the surface has no texture coordinates"});
    }

    TEST_F(obj_folder, refuses_with_the_place)
    {
        struct refusal_case {
            std::string text;
            const char* said;
        };
        const refusal_case in_mtl[] = {
            {"Kd 1 1 x\n", "m.mtl:2:8: error: found \"x\"; expected three numbers"},
            {"Kd red\n", "m.mtl:2:4: error: found \"red\"; expected one number or three"},
            {"Kd 1 1\n", "m.mtl:2:7: error: found the end of the line; expected three numbers"},
            {"Ns nan\n", "m.mtl:2:4: error: found \"nan\"; expected a number up to 10^15"},
            {"d 1 2\n", "m.mtl:2:5: error: found \"2\"; expected the end of the line"},
            {"map_Kd -x 1 a.png\n",
                "m.mtl:2:8: error: found \"-x 1 a.png\"; expected an option of MTL files or a file's name"},
            {"map_Kd -s a.png\n", "m.mtl:2:11: error: found \"a.png\"; expected a number up to 10^6"},
            {"map_Kd ../a.png\n",
                "m.mtl:2:1: error: ../a.png: lies outside of the scene's folder; --allow-outside lets scenes name such "
                "files"},
            {"Ke -1 0 0\n", "m.mtl:1:1: error: material \"a\": Ke must not be below 0"},
        };
        for (const auto& c : in_mtl)
            EXPECT_EQ(said_of_material(c.text), std::vector<std::string>{c.said}) << c.text;
        write("bad.mtl", "# a\n Kd 1 1 1\n");
        const refusal_case in_obj[] = {
            {"mtllib bad.mtl\n" + square_with_coordinates, "bad.mtl:2:2: error: found \"Kd\" before the first newmtl"},
            {"mtllib ../m.mtl\n" + square_with_coordinates,
                "s.obj:1:1: error: ../m.mtl: lies outside of the scene's folder; --allow-outside lets scenes name such "
                "files"},
            {"mtllib\n" + square_with_coordinates, "s.obj:1:1: error: found mtllib without a file's name"},
            {"v 0 0 0\np 1\n",
                "s.obj: error: the file has no face; points, lines and curves have no surface that could be drawn"},
            {square_with_coordinates + "f 1 2 9\n", "s.obj:10:7: error: found vertex 9; there are 4"},
        };
        for (const auto& c : in_obj)
            EXPECT_EQ(said(c.text), std::vector<std::string>{c.said}) << c.text;
        EXPECT_THROW(read(square_with_coordinates, {.unit = 0.0}), std::invalid_argument);
    }

    // Line endings of old Macs, byte order marks, UTF-16.
    TEST_F(obj_folder, reads_texts_in_other_encodings)
    {
        const auto expected = *read(square_with_coordinates).scene.meshes.at(0).surface;
        auto mac = square_with_coordinates;
        std::replace(mac.begin(), mac.end(), '\n', '\r');
        EXPECT_EQ(*read(mac).scene.meshes.at(0).surface, expected);
        EXPECT_EQ(*read("\xEF\xBB\xBF" + square_with_coordinates).scene.meshes.at(0).surface, expected);
        std::string big("\xFE\xFF"), little("\xFF\xFE");
        for (const char c : square_with_coordinates + "f 1 2 x\n") {
            big += '\0';
            big += c;
            little += c;
            little += '\0';
        }
        EXPECT_EQ(said(big),
            std::vector<std::string>{"s.obj:10:7: error: found \"x\"; expected the number of a vertex, "
                                     "counted from 1, or with a sign from the last one back"});
        EXPECT_EQ(said(little), said(big));
        EXPECT_EQ(*read(big.substr(0, 2 + 2 * square_with_coordinates.size())).scene.meshes.at(0).surface, expected);
    }

    // Fans of triangles would cover what lies outside of a face that is not convex.
    TEST_F(obj_folder, faces_that_are_not_convex_keep_their_area)
    {
        struct polygon_case {
            std::vector<glm::dvec2> corners;
        };
        std::vector<glm::dvec2> star, comb;
        for (int i = 0; i < 10; ++i)
            star.emplace_back(
                (i % 2 == 0 ? 2.0 : 0.5) * glm::dvec2(std::cos(i * 0.62831853), std::sin(i * 0.62831853)));
        for (int i = 0; i < 40; ++i)
            comb.emplace_back(0.5 * i, i % 2 == 0 ? 0 : 5);
        comb.emplace_back(20, -1);
        comb.emplace_back(0, -1);
        std::reverse(comb.begin(), comb.end());
        const polygon_case cases[] = {{{{0, 0}, {4, 0}, {1, 1}, {0, 4}}}, {{{4, 0}, {1, 1}, {0, 4}, {0, 0}}},
            {{{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}}, {star}, {comb}};
        for (const auto& c : cases) {
            std::string text, face = "f";
            double area = 0;
            for (std::size_t i = 0; i < c.corners.size(); ++i) {
                const auto &a = c.corners[i], &b = c.corners[(i + 1) % c.corners.size()];
                area += 0.5 * (a.x * b.y - a.y * b.x); // the shoelace formula
                text += "v " + std::to_string(a.x) + " " + std::to_string(a.y) + " " + std::to_string(a.x + a.y) + "\n";
                face += " " + std::to_string(i + 1);
            }
            const auto made = read(text + face + "\n");
            const auto& m = made.scene.meshes.at(0);
            ASSERT_EQ(m.surface->triangles.size(), c.corners.size() - 2);
            double sum = 0;
            for (std::size_t t = 0; t < m.surface->triangles.size(); ++t) {
                const auto k = corners_of(m, t);
                const auto normal = glm::cross(k[1] - k[0], k[2] - k[0]);
                EXPECT_GE(normal.z * area, -1e-9) << "a triangle is turned over";
                sum += 0.5 * normal.z;
            }
            EXPECT_NEAR(sum, area, 1e-4);
        }
    }

    TEST_F(obj_folder, ply_files_are_scenes)
    {
        const auto ply = [](const std::string& properties, const std::string& more, const std::string& of_vertex) {
            return "ply\nformat ascii 1.0\n" + more
                + "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n" + properties
                + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0" + of_vertex + "1 0 0"
                + of_vertex + "0 1 0" + of_vertex + "3 0 1 2\n";
        };
        write("a.ply", ply("", "", "\n"));
        const auto plain = import_scene((folder / "a.ply").string(), {.strict = true, .unit = 0.5});
        ASSERT_EQ(plain.scene.meshes.size(), 1u);
        EXPECT_EQ(plain.scene.meshes[0].file, "a.ply");
        EXPECT_EQ(plain.scene.meshes[0].linear, glm::dmat3(0.5));
        EXPECT_EQ(first_material(plain).reflectance, dvec3(0.5));
        const auto of = [&](const std::string& text) { return parse_ply_scene((folder / "s.ply").string(), text); };
        const auto coloured
            = of(ply("property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n", "",
                " 255 0 0 9\n"));
        EXPECT_EQ(first_material(coloured).reflectance, dvec3(1)); // which the colours are factors on
        EXPECT_EQ(coloured.scene.meshes[0].surface->colors[0], glm::vec3(1, 0, 0));
        EXPECT_TRUE(
            notes_of(coloured).at(0).ends_with("s.ply:10:1: note: the property \"alpha\" of each vertex is left out"));

        write_picture("a b.tga", {{{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 255}}});
        const auto textured
            = of(ply("property float s\nproperty float t\n", "comment TextureFile a b.tga\n", " 0 1\n"));
        ASSERT_TRUE(first_material(textured).texture.map);
        EXPECT_EQ(first_material(textured).texture.map->texels[0], glm::u16vec4(65535, 0, 0, 65535));
        EXPECT_EQ(first_material(textured).reflectance, dvec3(1));
        auto with_edge = ply("", "comment TextureFile a b.tga\nelement edge 1\nproperty int v\n", "\n");
        with_edge.insert(with_edge.find("end_header\n") + 11, "7 ");
        const auto no_coordinates = of(with_edge);
        EXPECT_TRUE(notes_of(no_coordinates).at(0).ends_with("s.ply:4:1: note: the elements \"edge\" are left out"));
        EXPECT_TRUE(notes_of(no_coordinates)
                        .at(1)
                        .ends_with("s.ply:3:1: note: a picture is left out: the vertices have no texture coordinates"));
        EXPECT_EQ(refusal_by([&] {
            return parse_ply_scene("s.ply",
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                "end_header\n0 0 0\n");
        })
                      .find("s.ply:8:1: error: the header declares neither faces with the list vertex_indices nor "
                            "strips of triangles; a cloud of points has no surface"),
            0u);
    }

} // namespace
} // namespace photongrid
