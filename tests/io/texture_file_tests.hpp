// Textures and colours of vertices in scene files and PLY files.
#pragma once

#include "light_file_tests.hpp"

#include <photongrid/io/ply_file.hpp>

namespace photongrid {
namespace {

    /// `good`, with a mesh of a material with these keys.
    std::string text_with_texture(const std::string& keys, const std::string& mesh)
    {
        auto lines = good;
        lines[5] = R"(  "white": {"type": "lambertian", "reflectance": 0.5, )" + keys + "},";
        lines[9] = R"(  {"type": "mesh", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]], )"
            + mesh + R"("material": "white"}],)";
        return text(lines);
    }
    const std::string with_coordinates = R"("texture_coordinates": [[0, 0], [1, 0], [0.5, -2]], )";

    TEST(textures_in_a_scene, are_read_and_written)
    {
        const auto folder = picture_folder();
        write_png(folder / "wood.png", PNG_FORMAT_RGB, {255, 188, 0, 55, 0, 255});
        const auto file = (folder / "s.json").string();
        const auto plain = parse_scene(file, text_with_texture(R"("texture": "wood.png")", with_coordinates));
        const auto& t = plain.materials.at(0).texture;
        ASSERT_TRUE(t.map);
        EXPECT_EQ(t.map->width, 2u);
        ASSERT_EQ(t.map->texels.size(), 2u);
        EXPECT_EQ(t.map->texels[0], glm::u16vec4(65535, 32957, 0, 65535)); // 0.5028865 x 65535
        EXPECT_EQ(t.map->texels[1], glm::u16vec4(2504, 0, 65535, 65535));
        EXPECT_EQ(t.wrap, texture_wrap::repeat);
        EXPECT_EQ(
            plain.meshes.at(0).surface->texture_coordinates, (std::vector<glm::vec2>{{0, 0}, {1, 0}, {0.5f, -2}}));
        EXPECT_TRUE(parse_scene(file, scene_text(plain, plain.render)) == plain);

        const auto moved = parse_scene(file,
            text_with_texture(
                R"("texture": {"file": "wood.png", "wrap": "clamp", "scale": [2, 3], "offset": [0.5, 0]})",
                with_coordinates + R"("colors": [1, [0, 0.5, 1], 0], )"));
        EXPECT_EQ(moved.materials[0].texture.wrap, texture_wrap::clamp);
        EXPECT_EQ(moved.materials[0].texture.scale, glm::dvec2(2, 3));
        EXPECT_EQ(moved.materials[0].texture.offset, glm::dvec2(0.5, 0));
        EXPECT_EQ(moved.meshes[0].surface->colors, (std::vector<glm::vec3>{{1, 1, 1}, {0, 0.5f, 1}, {0, 0, 0}}));
        EXPECT_TRUE(parse_scene(file, scene_text(moved, moved.render)) == moved);
        auto in_memory = moved;
        in_memory.materials[0].texture.file.clear();
        EXPECT_THROW(scene_text(in_memory, in_memory.render), std::invalid_argument);
    }

    TEST(textures_in_a_scene, that_are_wrong_are_refused_with_their_place)
    {
        const auto folder = picture_folder();
        write_png(folder / "wood.png", PNG_FORMAT_RGB, {255, 188, 0, 55, 0, 255});
        std::ofstream(folder / "no.png", std::ios::binary) << "no picture";
        struct bad {
            std::string keys, mesh, what;
            int line;
        };
        const std::string wood = R"("texture": "wood.png")";
        for (const auto& b : {bad{R"("texture": "none.png")", with_coordinates, "none.png", 6},
                 {R"("texture": "no.png")", with_coordinates, "is no picture", 6},
                 {R"("texture": "../wood.png")", with_coordinates, "in the scene's folder", 6},
                 {R"("texture": 3)", with_coordinates, "the name of a file", 6},
                 {R"("texture": {"wrap": "clamp"})", with_coordinates, "\"file\"", 6},
                 {R"("texture": {"file": "wood.png", "wrap": "mirror"})", with_coordinates, "\"clamp\"", 6},
                 {R"("texture": {"file": "wood.png", "scale": 2})", with_coordinates, "[u, v]", 6},
                 {R"("texture": {"file": "wood.png", "offset": [1e7, 0]})", with_coordinates, "10^6", 6},
                 {wood, "", "texture coordinates", 10},
                 {wood, R"("texture_coordinates": [[0, 0]], )", "each of the 3 positions", 10},
                 {wood, R"("texture_coordinates": [[0, 0], [1, 0], [1, 2e6]], )", "10^6", 10},
                 {"\"comment\": 1", R"("colors": [1, 1], )", "each of the 3 positions", 10},
                 {"\"comment\": 1", R"("colors": [1, 1, 2], )", "0 to 1", 10}}) {
            const auto message = refusal_by(
                [&] { return parse_scene((folder / "s.json").string(), text_with_texture(b.keys, b.mesh)); });
            EXPECT_NE(message.find(b.what), std::string::npos) << b.keys << b.mesh << ": " << message;
            EXPECT_NE(message.find("s.json:" + std::to_string(b.line) + ":"), std::string::npos) << message;
        }
        auto on_a_sphere = good;
        on_a_sphere[6] = R"(  "clear": {"type": "glass", "index_of_refraction": 1.5, "texture": "wood.png"}},)";
        const auto message = refusal_by([&] { return parse_scene((folder / "s.json").string(), text(on_a_sphere)); });
        EXPECT_NE(message.find("s.json:9:"), std::string::npos) << message;
        EXPECT_NE(message.find("texture coordinates"), std::string::npos) << message;
    }

    TEST(textures_in_a_scene, that_are_numbers_are_channels_as_the_file_has_them)
    {
        const auto folder = picture_folder();
        write_png(folder / "four.png", PNG_FORMAT_RGBA, {0, 51, 102, 204, 255, 188, 55, 1});
        const auto file = (folder / "s.json").string();
        const auto s = parse_scene(file,
            text_with_texture(
                R"("opacity": 0.25, "opacity_texture": {"file": "four.png", "channel": "alpha", "wrap": "clamp"},)"
                R"( "texture": "four.png")",
                with_coordinates));
        const auto& m = s.materials.at(0);
        EXPECT_EQ(m.opacity, 0.25);
        EXPECT_EQ(m.opacity_texture.channel, texture_channel::alpha);
        EXPECT_EQ(m.opacity_texture.wrap, texture_wrap::clamp);
        ASSERT_EQ(m.opacity_texture.map->texels.size(), 2u);
        EXPECT_EQ(m.opacity_texture.map->texels[0], glm::u16vec4(0, 51 * 257, 102 * 257, 204 * 257));
        EXPECT_EQ(m.opacity_texture.map->texels[1], glm::u16vec4(65535, 188 * 257, 55 * 257, 257));
        EXPECT_EQ(m.texture.map->texels[1], glm::u16vec4(65535, 32957, 2504, 65535)) << "a colour is decoded";
        EXPECT_TRUE(parse_scene(file, scene_text(s, s.render)) == s);
        const auto metal = parse_scene(file,
            text_with_texture(R"("opacity_texture": "four.png"}, "steel": {"type": "metal", "reflectance": 0.5, )"
                              R"("roughness": 0.5, "roughness_texture": {"file": "four.png", "channel": "green"})",
                with_coordinates));
        EXPECT_EQ(metal.materials.at(0).opacity_texture.channel, texture_channel::red);
        EXPECT_EQ(metal.materials.at(1).roughness_texture.channel, texture_channel::green);
        EXPECT_TRUE(metal.materials[0].opacity_texture.map == metal.materials[1].roughness_texture.map) << "read once";
        EXPECT_TRUE(parse_scene(file, scene_text(metal, metal.render)) == metal);
        write_image((folder / "half.pfm").string(), {.width = 1, .height = 1, .pixels = {glm::vec3(0.5f)}});
        const auto floats = parse_scene(
            file, text_with_texture(R"("opacity_texture": {"file": "half.pfm", "channel": "blue"})", with_coordinates));
        EXPECT_EQ(floats.materials[0].opacity_texture.map->texels[0], glm::u16vec4(32768, 32768, 32768, 65535));
    }

    TEST(mixtures_in_a_scene, are_read_and_written)
    {
        auto lines = good;
        lines[5] = R"(  "rust": {"type": "mixture", "materials": ["steel", "white"], "share": 0.75},)"
                   R"( "steel": {"type": "metal", "reflectance": 0.5},)"
            + lines[5];
        const auto s = parse_scene("s.json", text(lines));
        const auto& m = s.materials.at(0);
        EXPECT_EQ(m.kind, material_kind::mixture);
        EXPECT_EQ(s.materials.at(m.parts[0]).name, "steel");
        EXPECT_EQ(s.materials.at(m.parts[1]).name, "white");
        EXPECT_EQ(m.share, 0.75);
        EXPECT_TRUE(parse_scene("s.json", scene_text(s, s.render)) == s);
    }

    TEST(mixtures_in_a_scene, that_are_wrong_are_refused_with_their_place)
    {
        struct bad {
            const char *materials, *what;
        };
        const std::string steel = R"("steel": {"type": "metal", "reflectance": 0.5})";
        for (const auto& b :
            {bad{R"("rust": {"type": "mixture", "materials": ["steel", "whte"], "share": 0.75})", "\"white\""},
                {R"("rust": {"type": "mixture", "materials": ["steel"], "share": 0.75})", "two materials"},
                {R"("rust": {"type": "mixture", "materials": "steel", "share": 0.75})", "two materials"},
                {R"("rust": {"type": "mixture", "materials": ["steel", 3], "share": 0.75})", "name of a material"},
                {R"("rust": {"type": "mixture", "materials": ["steel", "white"]})", "\"share\""},
                {R"("rust": {"type": "mixture", "share": 0.5})", "\"materials\""},
                {R"("rust": {"type": "mixture", "materials": ["steel", "white"], "share": 1.5})", "from 0 to 1"},
                {R"("rust": {"type": "mixture", "materials": ["steel", "rust"], "share": 0.5})", "mixture itself"},
                {R"("rust": {"type": "mixture", "materials": ["steel", "white"], "share": 0.5, "texture": "a.png"})",
                    "\"texture\""},
                {R"("thin": {"type": "mirror", "opacity": 0.5}, "rust": {"type": "mixture", "materials": ["white", )"
                 R"("thin"], "share": 0.5})",
                    "opacity"},
                {R"("toy": {"type": "plastic", "reflectance": 0.5}, "rust": {"type": "mixture", "materials": )"
                 R"(["white", "toy"], "share": 0.5})",
                    "coat"},
                {R"("thin": {"type": "mirror", "opacity": 1.5})", "from 0 to 1"},
                {R"("thin": {"type": "mirror", "roughness_texture": "a.png"})", "\"roughness_texture\""},
                {R"("toy": {"type": "plastic", "reflectance": 0.5, "energy": "single"})", "\"energy\""},
                {R"("thin": {"type": "metal", "reflectance": 0.5, "energy": "lots"})", "\"lots\""},
                {R"("toy": {"type": "plastic", "reflectance": 0.5, "roughness_texture": "a.png"})",
                    "\"roughness_texture\""},
                {R"("thin": {"type": "mirror", "opacity_texture": {"file": "a.png", "channel": "cyan"}})", "a.png"}}) {
            auto lines = good;
            lines[5] = "  " + std::string(b.materials) + ", " + steel + "," + lines[5];
            const auto message = refusal_by([&] { return parse_scene("s.json", text(lines)); });
            EXPECT_NE(message.find(b.what), std::string::npos) << b.materials << ": " << message;
            EXPECT_NE(message.find("s.json:6:"), std::string::npos) << message;
        }
        // Of shapes, only meshes are clear; the message names the shape's line.
        auto lines = good;
        lines[6] = R"(  "clear": {"type": "glass", "index_of_refraction": 1.5, "opacity": 0.5}},)";
        const auto message = refusal_by([&] { return parse_scene("s.json", text(lines)); });
        EXPECT_NE(message.find("s.json:9:"), std::string::npos) << message;
        EXPECT_NE(message.find("only meshes"), std::string::npos) << message;
    }

    TEST(ply_file, has_texture_coordinates_and_colors_of_vertices)
    {
        const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                 "property float z\n",
                          tail = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
        const auto bytes = parse_ply("a.ply",
            head + "property float s\nproperty float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                + tail + "0 0 0 0.5 -1 255 0 188\n1 0 0 1 2 55 0 0\n0 1 0 0 0 0 0 0\n3 0 1 2\n");
        EXPECT_EQ(bytes.texture_coordinates, (std::vector<glm::vec2>{{0.5f, -1}, {1, 2}, {0, 0}}));
        ASSERT_EQ(bytes.colors.size(), 3u);
        EXPECT_NEAR(bytes.colors[0].z, 0.5028865f, 1e-6f);
        EXPECT_NEAR(bytes.colors[1].x, 0.0382044f, 1e-6f);
        const auto floats = parse_ply("a.ply",
            head
                + "property float texture_u\nproperty float texture_v\nproperty float red\nproperty float green\n"
                  "property float blue\n"
                + tail + "0 0 0 0 0 1 0.5 0\n1 0 0 0 0 0 0 0\n0 1 0 0 0 0 0 0\n3 0 1 2\n");
        EXPECT_EQ(floats.colors[0], glm::vec3(1, 0.5f, 0));
        const auto half
            = parse_ply("a.ply", head + "property float u\n" + tail + "0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n");
        EXPECT_TRUE(half.texture_coordinates.empty()) << "v is missing";
        const auto refused = [&](const std::string& property, const std::string& value) {
            return refusal_by([&] {
                return parse_ply("a.ply",
                    head + "property " + property
                        + " red\nproperty float green\nproperty float blue\nproperty float u\n"
                          "property float v\n"
                        + tail + "0 0 0 " + value + "\n1 0 0 0 0 0 0 0\n0 1 0 0 0 0 0 0\n3 0 1 2\n");
            });
        };
        for (const auto* value : {"255 0 0 0 0", "256 0 0 0 0", "1.5 0 0 0 0", "0 0 0 1e9 0"})
            for (const auto* type : {"uchar", "float"})
                EXPECT_EQ(refused(type, value), "") << "one odd value refuses no file";
    }

} // namespace
} // namespace photongrid
