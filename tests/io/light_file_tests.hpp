// Spotlights, sphere lights, directional light and environments in scene files, and the pictures of environments.
#pragma once

#include "scene_texts.hpp"

#include <photongrid/io/image_file.hpp>
#include <photongrid/io/scene_edit.hpp>

#include <png.h>

namespace photongrid {
namespace {

    /// `good` with these lights.
    std::string text_with_lights(const std::string& lights)
    {
        auto lines = good;
        lines[11] = "  " + lights + "],";
        return text(lines);
    }

    /// A folder of pictures of 2 x 1 pixels whose radiance is (1, 0.5, 0.25) and (0.125, 0, 2), or what a format makes
    /// of them.
    std::filesystem::path picture_folder()
    {
        const auto folder = std::filesystem::temp_directory_path() / "photongrid_lights";
        std::filesystem::create_directories(folder);
        const image picture{.width = 2, .height = 1, .pixels = {{1, 0.5f, 0.25f}, {0.125f, 0, 2}}};
        write_image((folder / "sky.exr").string(), picture);
        write_image((folder / "sky.pfm").string(), picture);
        // Mantissas and a common exponent: 2^(e - 136).
        std::ofstream(folder / "sky.hdr", std::ios::binary) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"
                                                            << std::string("\x80\x40\x20\x81\x08\x00\x80\x82", 8);
        return folder;
    }

    void write_png(const std::filesystem::path& path, std::uint32_t format, const std::vector<unsigned char>& bytes)
    {
        png_image png{};
        png.version = PNG_IMAGE_VERSION;
        png.width = 2;
        png.height = 1;
        png.format = format;
        ASSERT_TRUE(png_image_write_to_file(&png, path.c_str(), 0, bytes.data(), 0, nullptr));
    }

    TEST(lights_in_a_scene, are_read_and_written)
    {
        const auto s = parse_scene("s.json",
            text_with_lights(
                R"({"type": "spot", "name": "desk", "position": [0, 2, 0], "direction": [0, -2, 0], "inner_angle": 10, )"
                R"("outer_angle": 25.5, "power": 3}, {"type": "sphere_light", "center": [1, 2, 3], "radius": 0.5, )"
                R"("power": [1, 2, 3]}, {"type": "directional", "direction": [1, -1, 0], "irradiance": [4, 5, 6]}, )"
                R"({"type": "environment", "radiance": 0.5, "rotate": {"axis": [0, 1, 0], "degrees": 90}})"));
        ASSERT_EQ(s.spot_lights.size(), 1u);
        EXPECT_EQ(s.spot_lights[0], (spot_light{"desk", {0, 2, 0}, {0, -2, 0}, 10, 25.5, dvec3(3)}));
        ASSERT_EQ(s.sphere_lights.size(), 1u);
        EXPECT_EQ(s.sphere_lights[0], (sphere_light{"lights[1]", {1, 2, 3}, 0.5, {1, 2, 3}}));
        ASSERT_EQ(s.directional_lights.size(), 1u);
        EXPECT_EQ(s.directional_lights[0], (directional_light{"lights[2]", {1, -1, 0}, {4, 5, 6}}));
        ASSERT_EQ(s.environment_lights.size(), 1u);
        EXPECT_EQ(s.environment_lights[0], (environment_light{"lights[3]", "", nullptr, dvec3(0.5), {0, 1, 0}, 90}));
        EXPECT_TRUE(parse_scene("again.json", scene_text(s, s.render)) == s);
        const auto white = parse_scene("s.json", text_with_lights(R"({"type": "environment"})"));
        EXPECT_EQ(white.environment_lights.at(0).radiance, dvec3(1));
    }

    TEST(lights_in_a_scene, have_lengths_in_the_files_units_and_radiance_in_si)
    {
        auto lines = good;
        lines[2] = R"( "units": {"length": "cm", "power": "mW"},)";
        lines[11]
            = R"(  {"type": "sphere_light", "center": [100, 0, 0], "radius": 50, "power": 1000},)"
              R"( {"type": "directional", "direction": [0, -1, 0], "irradiance": 7}, {"type": "environment", "radiance": 3}],)";
        const auto s = parse_scene("s.json", text(lines));
        EXPECT_EQ(s.sphere_lights.at(0), (sphere_light{"lights[0]", {1, 0, 0}, 0.5, dvec3(1)}));
        EXPECT_EQ(s.directional_lights.at(0).irradiance, dvec3(7));
        EXPECT_EQ(s.environment_lights.at(0).radiance, dvec3(3));
    }

    TEST(lights_in_a_scene, take_environments_from_pictures_of_every_format)
    {
        const auto folder = picture_folder();
        const std::vector<glm::vec3> linear{{1, 0.5f, 0.25f}, {0.125f, 0, 2}};
        for (const std::string name : {"sky.exr", "sky.pfm", "sky.hdr"}) {
            const auto s = parse_scene(
                (folder / "s.json").string(), text_with_lights(R"({"type": "environment", "file": ")" + name + "\"}"));
            const auto& sky = s.environment_lights.at(0);
            ASSERT_TRUE(sky.map) << name;
            EXPECT_EQ(sky.file, name);
            EXPECT_EQ(sky.map->width, 2u);
            EXPECT_EQ(sky.map->radiance, linear) << name;
            EXPECT_TRUE(parse_scene((folder / "again.json").string(), scene_text(s, s.render)) == s) << name;
        }
        // sRGB: 188 is 0.502886, 55 is 0.038204; half transparent, the colour stays.
        write_png(folder / "sky.png", PNG_FORMAT_RGB, {255, 188, 0, 55, 0, 255});
        write_png(folder / "clear.png", PNG_FORMAT_RGBA, {255, 188, 0, 128, 55, 0, 255, 255});
        for (const auto* name : {"sky.png", "clear.png"}) {
            const auto decoded = read_linear_image((folder / name).string());
            ASSERT_EQ(decoded.pixels.size(), 2u);
            const std::vector<glm::vec3> known{{1, 0.502886f, 0}, {0.038204f, 0, 1}};
            for (int i = 0; i < 2; ++i)
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(
                        decoded.pixels[static_cast<std::size_t>(i)][c], known[static_cast<std::size_t>(i)][c], 1e-6f)
                        << name;
        }
    }

    /// A grey JPEG of 8 x 8 pixels of 188: tables of 1, and one block of a constant, 8 (188 - 128).
    std::string grey_jpeg()
    {
        std::string bytes("\xFF\xD8\xFF\xDB\x00\x43\x00", 7);
        bytes.append(64, '\x01');
        bytes += std::string("\xFF\xC0\x00\x0B\x08\x00\x08\x00\x08\x01\x01\x11\x00", 13);
        for (const char* table : {"\x00\x09", "\x10\x00"}) { // one code of one bit each
            bytes += std::string("\xFF\xC4\x00\x14", 4) + table[0] + '\x01';
            bytes.append(15, '\0');
            bytes += table[1];
        }
        return bytes + std::string("\xFF\xDA\x00\x08\x01\x01\x00\x00\x3F\x00\x78\x1F\xFF\xD9", 14);
    }

    TEST(lights_in_a_scene, take_jpeg_files_too)
    {
        const auto path = (picture_folder() / "grey.jpg").string();
        const auto whole = grey_jpeg();
        std::ofstream(path, std::ios::binary) << whole;
        const auto grey = read_linear_image(path);
        ASSERT_EQ(grey.width, 8u);
        ASSERT_EQ(grey.pixels.size(), 64u);
        for (const auto& p : grey.pixels)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(p[c], 0.5028865f, 1e-6f);
        for (std::size_t n = 0; n + 4 < whole.size(); ++n) {
            std::ofstream(path, std::ios::binary) << whole.substr(0, n);
            EXPECT_THROW(read_linear_image(path), file_error) << n;
        }
    }

    TEST(lights_in_a_scene, that_are_wrong_are_refused_with_their_place)
    {
        const auto folder = picture_folder();
        write_image((folder / "dark.exr").string(), {.width = 1, .height = 1, .pixels = {{0, 0, 0}}});
        std::ofstream(folder / "cut.hdr", std::ios::binary) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9 +X 2\n\x80";
        std::ofstream(folder / "cut.jpg", std::ios::binary) << "\xFF\xD8\xFF";
        std::ofstream(folder / "no.png", std::ios::binary) << "no picture";
        std::ofstream(folder / "sky.gif", std::ios::binary) << "GIF89a";
        struct bad {
            std::string light, what;
        };
        const std::string spot = R"("type": "spot", "position": [0, 2, 0], "power": 3, )";
        for (const auto& b :
            {bad{spot + R"("direction": [0, 0, 0], "inner_angle": 1, "outer_angle": 2)", "shorter than"},
                {spot + R"("direction": [0, 1, 0], "inner_angle": 3, "outer_angle": 2)", "at most outer_angle"},
                {spot + R"("direction": [0, 1, 0], "inner_angle": 0, "outer_angle": 0)", "0.01"},
                {spot + R"("direction": [0, 1, 0], "inner_angle": 0, "outer_angle": 181)", "0 to 180"},
                {spot + R"("direction": [0, 1, 0], "outer_angle": 20)", "inner_angle"},
                {R"("type": "sphere_light", "center": [0, 0, 0], "radius": 0, "power": 1)", "1e-9"},
                {R"("type": "sphere_light", "center": [0, 0, 0], "radius": 1, "power": 0)", "power"},
                {R"("type": "directional", "direction": [0, 1, 0], "irradiance": 0)", "irradiance"},
                {R"("type": "directional", "direction": [0, 1, 0], "irradiance": [1, -1, 0])", "0 to 1e15"},
                {R"("type": "environment", "radiance": 0)", "radiance"},
                {R"("type": "environment", "file": "none.exr")", "none.exr"},
                {R"("type": "environment", "file": "../sky.exr")", "in the scene's folder"},
                {R"("type": "environment", "file": "dark.exr")", "black"},
                {R"("type": "environment", "file": "cut.hdr")", "cannot be read"},
                {R"("type": "environment", "file": "cut.jpg")", "cannot be read"},
                {R"("type": "environment", "file": "no.png")", "is no picture"},
                {R"("type": "environment", "file": "sky.gif")", "is no picture"},
                {R"("type": "environment", "rotate": {"axis": [0, 1, 0], "degrees": 400})", "-360 to 360"},
                {R"("type": "environment"}, {"type": "environment")", "second environment"}}) {
            const auto message = refusal_by(
                [&] { return parse_scene((folder / "s.json").string(), text_with_lights("{" + b.light + "}")); });
            EXPECT_NE(message.find(b.what), std::string::npos) << b.light << ": " << message;
            EXPECT_NE(message.find("s.json:12:"), std::string::npos) << message;
        }
        scene in_memory = parse_scene("s.json", text_with_lights(R"({"type": "environment"})"));
        in_memory.environment_lights[0].map = std::make_shared<const environment_map>();
        EXPECT_THROW(scene_text(in_memory, in_memory.render), std::invalid_argument);
    }

    TEST(lights_in_a_scene, are_edited_in_their_text)
    {
        const auto before = text_with_lights(
            R"({"type": "spot", "position": [0, 2, 0], "direction": [0, -2, 0], "inner_angle": 10, "outer_angle": 25, )"
            R"("power": 3}, {"type": "environment"}, {"type": "directional", "direction": [1, -1, 0], "irradiance": 2})");
        auto s = parse_scene("s.json", before);
        EXPECT_EQ(edited_scene_text("s.json", before, s, s.render), before);
        s.spot_lights[0].outer_angle = 30;
        s.spot_lights[0].position.x = 0.5;
        s.environment_lights[0].radiance = {1, 2, 3};
        s.directional_lights[0].irradiance = dvec3(4);
        EXPECT_TRUE(parse_scene("s.json", edited_scene_text("s.json", before, s, s.render)) == s);
        s.environment_lights[0].degrees = 3;
        EXPECT_THROW(edited_scene_text("s.json", before, s, s.render), std::invalid_argument);
    }

} // namespace
} // namespace photongrid
