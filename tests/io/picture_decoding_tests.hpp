// Pictures of scenes in all the forms that their formats allow, and what their headers may claim.
#pragma once

#include "image_under_test.hpp"

#include <photongrid/io/import/scene_files.hpp>

#include <ImfOutputFile.h>
#include <jpeglib.h>

#include <csetjmp>

namespace photongrid {
namespace {

    /// What a PNG is written with.
    struct png_form {
        int type = PNG_COLOR_TYPE_RGB, depth = 8, interlace = PNG_INTERLACE_NONE;
        double gamma = 0;                    ///< 0: no gAMA
        bool srgb = false;                   ///< an sRGB chunk
        std::vector<png_color> palette{};    ///< none: no palette
        std::vector<png_byte> transparent{}; ///< alpha of the palette
    };
    void write_png(const std::string& path, std::uint32_t width, const png_form& form, std::vector<png_byte> bytes)
    {
        const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"), std::fclose);
        auto* png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
        auto* info = png_create_info_struct(png);
        png_init_io(png, file.get());
        const int channels = form.type == PNG_COLOR_TYPE_RGB ? 3 : form.type == PNG_COLOR_TYPE_RGBA ? 4 : 1;
        const std::size_t row_bytes = (width * static_cast<std::size_t>(channels * form.depth) + 7) / 8;
        const auto height = static_cast<png_uint_32>(bytes.size() / row_bytes);
        png_set_IHDR(png, info, width, height, form.depth, form.type, form.interlace, PNG_COMPRESSION_TYPE_DEFAULT,
            PNG_FILTER_TYPE_DEFAULT);
        if (form.gamma > 0)
            png_set_gAMA(png, info, form.gamma);
        if (form.srgb)
            png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
        if (!form.palette.empty())
            png_set_PLTE(png, info, form.palette.data(), static_cast<int>(form.palette.size()));
        if (!form.transparent.empty())
            png_set_tRNS(png, info, form.transparent.data(), static_cast<int>(form.transparent.size()), nullptr);
        std::vector<png_bytep> rows;
        for (png_uint_32 y = 0; y < height; ++y)
            rows.push_back(bytes.data() + y * row_bytes);
        png_set_rows(png, info, rows.data());
        png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
        png_destroy_write_struct(&png, &info);
    }

    // The same grey is equally bright in 8 and in 16 bits, with a gamma or a profile or without: textures mean what
    // their material says, whatever an editor wrote beside them.
    TEST_F(image_file, png_values_are_as_they_are_stored)
    {
        const float grey = linear_value(188);
        for (const png_form& form : {png_form{}, png_form{.gamma = 0.45455}, png_form{.gamma = 1.0},
                 png_form{.srgb = true}, png_form{.interlace = PNG_INTERLACE_ADAM7}}) {
            write_png(path("a.png"), 3, form, std::vector<png_byte>(3 * 3 * 5, 188));
            auto wide = form;
            wide.depth = 16;
            write_png(path("b.png"), 3, wide, std::vector<png_byte>(2 * 3 * 3 * 5, 188)); // 188 * 257
            for (const auto* name : {"a.png", "b.png"}) {
                const auto p = read_linear_image(path(name));
                ASSERT_EQ(p.width, 3u);
                ASSERT_EQ(p.pixels.size(), 15u);
                for (const auto& pixel : p.pixels)
                    EXPECT_EQ(pixel, glm::vec3(grey)) << name;
            }
        }
        // Sixteen bits are not rounded to eight.
        write_png(path("c.png"), 2, {.type = PNG_COLOR_TYPE_GRAY, .depth = 16}, {0x12, 0x34, 0xFE, 0x01});
        const auto fine = read_channels(path("c.png"));
        EXPECT_EQ(fine.pixels[0], glm::vec4(glm::vec3(0x1234 / 65535.0f), 1));
        EXPECT_EQ(fine.pixels[1], glm::vec4(glm::vec3(0xFE01 / 65535.0f), 1));
        EXPECT_NEAR(
            read_linear_image(path("c.png")).pixels[0].x, std::pow((0x1234 / 65535.0 + 0.055) / 1.055, 2.4), 1e-6);
    }

    TEST_F(image_file, png_of_all_kinds_are_read)
    {
        write_png(path("bits.png"), 8, {.type = PNG_COLOR_TYPE_GRAY, .depth = 1}, {0b10100000});
        EXPECT_EQ(read_channels(path("bits.png")).pixels[0], glm::vec4(1));
        EXPECT_EQ(read_channels(path("bits.png")).pixels[1], glm::vec4(0, 0, 0, 1));
        EXPECT_EQ(read_channels(path("bits.png")).pixels[2], glm::vec4(1));
        write_png(path("few.png"), 2,
            {.type = PNG_COLOR_TYPE_PALETTE,
                .depth = 4,
                .palette = {{255, 0, 51}, {0, 102, 255}},
                .transparent = {255, 153}},
            {0x01});
        const auto few = read_channels(path("few.png"));
        EXPECT_EQ(few.pixels[0], glm::vec4(1, 0, 51 / 255.0f, 1));
        EXPECT_EQ(few.pixels[1], glm::vec4(0, 102 / 255.0f, 1, 153 / 255.0f));
        // Rows of interlaced pictures come in parts.
        std::vector<png_byte> ramp;
        for (int i = 0; i < 9 * 9 * 4; ++i)
            ramp.push_back(static_cast<png_byte>(i % 251));
        write_png(path("plain.png"), 9, {.type = PNG_COLOR_TYPE_RGBA}, ramp);
        write_png(path("laced.png"), 9, {.type = PNG_COLOR_TYPE_RGBA, .interlace = PNG_INTERLACE_ADAM7}, ramp);
        EXPECT_EQ(read_channels(path("laced.png")).pixels, read_channels(path("plain.png")).pixels);
        std::string bytes;
        for (const auto* name : {"plain.png", "laced.png"}) {
            const auto size = fs::file_size(path(name));
            for (std::uintmax_t n = size - 13; n-- > 0;) { // the last chunk says nothing
                fs::resize_file(path(name), n);
                EXPECT_NE(refusal([&] { read_channels(path(name)); }), "") << name << n;
            }
        }
    }

    std::string jpeg(J_COLOR_SPACE space, int quality, const std::vector<unsigned char>& pixel, bool progressive)
    {
        jpeg_compress_struct c{};
        jpeg_error_mgr errors{};
        c.err = jpeg_std_error(&errors);
        jpeg_create_compress(&c);
        unsigned char* data = nullptr;
        unsigned long size = 0;
        jpeg_mem_dest(&c, &data, &size);
        c.image_width = c.image_height = 16;
        c.input_components = static_cast<int>(pixel.size());
        c.in_color_space = space;
        jpeg_set_defaults(&c);
        jpeg_set_quality(&c, quality, TRUE);
        if (progressive)
            jpeg_simple_progression(&c);
        jpeg_start_compress(&c, TRUE);
        std::vector<unsigned char> row;
        for (int x = 0; x < 16; ++x)
            row.insert(row.end(), pixel.begin(), pixel.end());
        auto* at = row.data();
        for (int y = 0; y < 16; ++y)
            jpeg_write_scanlines(&c, &at, 1);
        jpeg_finish_compress(&c);
        std::string bytes(reinterpret_cast<char*>(data), size);
        jpeg_destroy_compress(&c);
        std::free(data);
        return bytes;
    }
    TEST_F(image_file, jpeg_of_all_kinds_are_read)
    {
        for (const bool progressive : {false, true}) {
            write_text(path("a.jpg"), jpeg(JCS_RGB, 100, {255, 102, 0}, progressive));
            write_text(path("grey.jpg"), jpeg(JCS_GRAYSCALE, 100, {102}, progressive));
            // With four inks; the program that writes Adobe's mark stores what is missing of them.
            write_text(path("ink.jpg"), jpeg(JCS_CMYK, 100, {255, 204, 102, 127}, progressive));
            const auto near = [](const glm::vec4& a, const glm::vec3& b) {
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(a[c], b[c], 2.5 / 255) << c;
            };
            near(read_channels(path("a.jpg")).pixels[100], glm::vec3(1, 0.4f, 0));
            near(read_channels(path("grey.jpg")).pixels[100], glm::vec3(0.4f));
            near(read_channels(path("ink.jpg")).pixels[100], glm::vec3(1, 0.8f, 0.4f) * (127 / 255.0f));
            const auto whole = jpeg(JCS_RGB, 100, {255, 102, 0}, progressive);
            for (std::size_t n = 0; n + 2 < whole.size(); n += 3) {
                write_text(path("cut.jpg"), whole.substr(0, n));
                EXPECT_NE(refusal([&] { read_channels(path("cut.jpg")); }), "") << n;
            }
        }
    }

    /// A Radiance picture of 2 x 3 pixels, red 1 to 6 in the order of the file.
    std::string radiance(const std::string& header, const std::string& size)
    {
        std::string bytes = "#?RADIANCE\n" + header + "\n" + size + "\n";
        for (int i = 1; i <= 6; ++i)
            bytes += std::string{static_cast<char>(i * 16), 0, 0, static_cast<char>(132)};
        return bytes;
    }
    std::vector<float> reds(const image& p)
    {
        std::vector<float> all;
        for (const auto& pixel : p.pixels)
            all.push_back(pixel.x);
        return all;
    }
    TEST_F(image_file, radiance_pictures_are_read_by_their_headers)
    {
        const std::string rgbe = "FORMAT=32-bit_rle_rgbe\n";
        const auto read = [&](const std::string& header, const std::string& size) {
            write_text(path("a.hdr"), radiance(header, size));
            return read_linear_image(path("a.hdr"));
        };
        EXPECT_EQ(reds(read(rgbe, "-Y 3 +X 2")), (std::vector<float>{1, 2, 3, 4, 5, 6}));
        EXPECT_EQ(reds(read(rgbe, "+Y 3 +X 2")), (std::vector<float>{5, 6, 3, 4, 1, 2})) << "rows from the bottom";
        EXPECT_EQ(reds(read(rgbe, "-Y 3 -X 2")), (std::vector<float>{2, 1, 4, 3, 6, 5})) << "from the right";
        const auto turned = read(rgbe, "+X 2 -Y 3");
        EXPECT_EQ(turned.width, 2u);
        EXPECT_EQ(turned.height, 3u);
        EXPECT_EQ(reds(turned), (std::vector<float>{1, 4, 2, 5, 3, 6})) << "columns from the left, each from the top";
        EXPECT_EQ(reds(read(rgbe, "-X 2 +Y 3")), (std::vector<float>{6, 3, 5, 2, 4, 1}));
        // Values are those of the file over the product of all its exposures.
        EXPECT_EQ(reds(read(rgbe + "EXPOSURE=4\n# made by hand\nEXPOSURE= 0.5\n", "-Y 3 +X 2")),
            (std::vector<float>{0.5, 1, 1.5, 2, 2.5, 3}));
        EXPECT_EQ(reds(read(rgbe + "COLORCORR= 2 3 4\n", "-Y 3 +X 2")), (std::vector<float>{0.5, 1, 1.5, 2, 2.5, 3}));
        EXPECT_EQ(reds(read(rgbe, "-Y 3 +X 2\r").pixels.empty() ? image{} : read(rgbe, "-Y 3 +X 2")).size(), 6u);
        const auto xyz = read("FORMAT=32-bit_rle_xyze\n", "-Y 3 +X 2");
        EXPECT_NEAR(xyz.pixels[0].x, 3.2406f, 1e-4);
        EXPECT_NEAR(xyz.pixels[0].z, 0.0557f, 1e-4);
        for (const auto* size : {"3 2", "-Y 3", "-Y 3 +Y 2", "-Y 0 +X 2", "-Y x +X 2", "-Y 3000000000 +X 2", ""}) {
            write_text(path("a.hdr"), radiance(rgbe, size));
            EXPECT_NE(refusal([&] { read_linear_image(path("a.hdr")); }), "") << size;
        }
        write_text(path("a.hdr"), radiance(rgbe + "EXPOSURE=none\n", "-Y 3 +X 2"));
        EXPECT_NE(refusal([&] { read_linear_image(path("a.hdr")); }).find("EXPOSURE"), std::string::npos);
        write_text(path("a.hdr"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe");
        EXPECT_NE(refusal([&] { read_linear_image(path("a.hdr")); }).find("header does not end"), std::string::npos);
    }

    TEST_F(image_file, tga_pixels_lie_where_their_descriptor_says)
    {
        const auto tga = [&](unsigned char descriptor, int depth) {
            std::string bytes(18, '\0');
            bytes[2] = 2; // colours, not compressed
            bytes[12] = 2;
            bytes[14] = 1;
            bytes[16] = static_cast<char>(depth);
            bytes[17] = static_cast<char>(descriptor);
            for (const char red : {'\x33', '\x66'}) {
                bytes += std::string{0, 0, red};
                if (depth == 32)
                    bytes += '\0';
            }
            write_text(path("a.tga"), bytes);
            return read_channels(path("a.tga")).pixels;
        };
        EXPECT_EQ(tga(0x20, 24)[0], glm::vec4(0.2f, 0, 0, 1));
        EXPECT_EQ(tga(0x30, 24)[0], glm::vec4(0.4f, 0, 0, 1)) << "from the right";
        EXPECT_EQ(tga(0x28, 32)[1], glm::vec4(0.4f, 0, 0, 0)) << "eight bits of alpha";
        EXPECT_EQ(tga(0x20, 32)[1], glm::vec4(0.4f, 0, 0, 1)) << "a byte that is no alpha";
    }

    /// Writes float channels of a data window, 1, 2 ... in each row by row, times their number from 1.
    void write_exr(const std::string& path, const Imath::Box2i& shown, const Imath::Box2i& data,
        const std::vector<std::string>& channels)
    {
        Imf::Header header(shown, data);
        Imf::FrameBuffer frame;
        std::vector<std::vector<float>> values;
        const auto width = static_cast<std::size_t>(data.max.x - data.min.x + 1);
        const auto size = width * static_cast<std::size_t>(data.max.y - data.min.y + 1);
        for (std::size_t c = 0; c < channels.size(); ++c) {
            values.emplace_back();
            for (std::size_t i = 0; i < size; ++i)
                values.back().push_back(static_cast<float>((i + 1) * (c + 1)));
        }
        for (std::size_t c = 0; c < channels.size(); ++c) {
            header.channels().insert(channels[c], Imf::Channel(Imf::FLOAT));
            frame.insert(channels[c], Imf::Slice::Make(Imf::FLOAT, values[c].data(), data, 4, 4 * width));
        }
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(data.max.y - data.min.y + 1);
    }
    TEST_F(image_file, exr_of_other_programs_are_read)
    {
        const Imath::Box2i two({0, 0}, {1, 0}), moved({5, -3}, {6, -3});
        write_exr(path("a.exr"), two, two, {"A", "B", "G", "R"});
        EXPECT_EQ(read_image(path("a.exr")).pixels, (std::vector<glm::vec3>{{4, 3, 2}, {8, 6, 4}}));
        write_exr(path("a.exr"), moved, moved, {"Y"});
        EXPECT_EQ(read_image(path("a.exr")).pixels, (std::vector<glm::vec3>{glm::vec3(1), glm::vec3(2)}));
        write_exr(path("a.exr"), two, two, {"Depth.Z", "View.Combined.B", "View.Combined.G", "View.Combined.R"});
        EXPECT_EQ(read_image(path("a.exr")).pixels, (std::vector<glm::vec3>{{4, 3, 2}, {8, 6, 4}}));
        // A part of the picture, which reaches beyond it.
        write_exr(path("a.exr"), {{0, 0}, {2, 1}}, {{1, 1}, {4, 1}}, {"B", "G", "R"});
        const auto part = read_image(path("a.exr"));
        EXPECT_EQ(part.width, 3u);
        const std::vector<glm::vec3> pixels{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {3, 2, 1}, {6, 4, 2}};
        EXPECT_EQ(part.pixels, pixels);
        write_exr(path("a.exr"), two, two, {"Z"});
        EXPECT_NE(refusal([&] { read_image(path("a.exr")); }).find("R, G and B"), std::string::npos);
    }

    TEST_F(image_file, pictures_are_known_by_their_content)
    {
        write_png(path("a.jpg"), 1, {}, {255, 0, 0});
        EXPECT_EQ(read_channels(path("a.jpg")).pixels[0], glm::vec4(1, 0, 0, 1));
        write_text(path("b.png"), jpeg(JCS_GRAYSCALE, 100, {255}, false));
        EXPECT_EQ(read_channels(path("b.png")).pixels[0], glm::vec4(1));
        write_image(path("c.pfm"), {.width = 1, .height = 1, .pixels = {{1, 2, 3}}});
        fs::rename(path("c.pfm"), path("c.hdr"));
        EXPECT_EQ(read_linear_image(path("c.hdr")).pixels[0], glm::vec3(1, 2, 3));
        write_text(path("d.gif"), "GIF89a");
        EXPECT_NE(refusal([&] { read_channels(path("d.gif")); }).find("expected EXR"), std::string::npos);
    }

    // A header may claim what would take all memory, in few bytes.
    TEST_F(image_file, headers_claim_no_more_than_the_pixels_allowed)
    {
        const auto claims = [&](const std::string& bytes) {
            write_text(path("a"), bytes);
            return refusal([&] { read_linear_image(path("a")); });
        };
        EXPECT_NE(claims("PF\n60000 60000\n-1.0\n").find("--max-pixels"), std::string::npos);
        EXPECT_NE(claims("PF\n70000 2\n-1.0\n").find("65,536"), std::string::npos);
        EXPECT_NE(claims("PF\n0 2\n-1.0\n").find("0 x 2"), std::string::npos);
        EXPECT_NE(claims("#?RADIANCE\n\n-Y 60000 +X 60000\n").find("--max-pixels"), std::string::npos);
        // All pictures of a scene together; bytes allow more.
        write_image(path("b.pfm"), {.width = 10, .height = 10, .pixels = std::vector<glm::vec3>(100, glm::vec3(1))});
        write_png(path("c.png"), 1000, {}, std::vector<png_byte>(3 * 1000 * 1000, 7));
        ASSERT_LT(fs::file_size(path("c.png")), 20'000u);
        for (const std::uint64_t most : {std::uint64_t{3000}, std::uint64_t{2'000'000}}) {
            scene_files files(folder, false, {.max_pixels = most});
            EXPECT_NE(files.texture("b.pfm", texture_holds::colour), nullptr) << "more bytes than pixels";
            EXPECT_EQ(refusal([&] { files.texture("c.png", texture_holds::colour); }).empty(), most > 3000);
        }
    }

    TEST_F(image_file, odd_values_of_a_picture_are_replaced_and_counted)
    {
        const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
        write_image(path("sky.pfm"),
            {.width = 2, .height = 2, .pixels = {{1, 2, 3}, {0, -1, 5}, {nan, 1, 1}, {infinity, 1, -infinity}}});
        std::vector<std::string> said;
        scene_files files(
            folder, false, {.note = [&](const auto& where, const auto& what) { said.push_back(where + ": " + what); }});
        const std::vector<glm::vec3> mended{{1, 2, 3}, {0, 0, 5}, {0, 1, 1}, {5, 1, 0}};
        EXPECT_EQ(files.environment("sky.pfm")->radiance, mended);
        ASSERT_EQ(said.size(), 1u);
        EXPECT_NE(said[0].find("sky.pfm: 4 values are no radiance, the first at pixel (1, 0)"), std::string::npos)
            << said[0];
        const auto t = files.texture("sky.pfm", texture_holds::colour);
        EXPECT_EQ(t->texels[2], glm::u16vec4(0, 65535, 65535, 65535));
        EXPECT_EQ(t->texels[3], glm::u16vec4(65535, 65535, 0, 65535));
        ASSERT_EQ(said.size(), 2u);
        EXPECT_NE(said[1].find("1 value is not a number at pixel (0, 1)"), std::string::npos) << said[1];
    }

} // namespace
} // namespace photongrid
