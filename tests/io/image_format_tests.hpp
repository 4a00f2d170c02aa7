// What formats of pictures hold.
#pragma once

#include "image_under_test.hpp"

#include <photongrid/render/film.hpp>

namespace photongrid {
namespace {

    TEST_F(image_file, exr_and_pfm_come_back_bit_for_bit)
    {
        const auto p = gradient();
        for (const auto* name : {"a.exr", "a.pfm", "a.PFM"}) {
            SCOPED_TRACE(name);
            write_image(path(name), p, 3.0, {{"seed", "7"}});
            const auto q = read_image(path(name));
            EXPECT_EQ(q.width, p.width);
            EXPECT_EQ(q.height, p.height);
            ASSERT_EQ(q.pixels.size(), p.pixels.size());
            EXPECT_EQ(std::memcmp(q.pixels.data(), p.pixels.data(), p.pixels.size() * sizeof(glm::vec3)), 0);
        }
    }

    image with_layers()
    {
        auto p = gradient();
        for (std::uint32_t i = 0; i < 35; ++i) {
            p.layers.radius.push_back(0.01f * static_cast<float>(i));
            p.layers.count.push_back(static_cast<float>(100 + i));
            p.layers.relative_error.push_back(1 / static_cast<float>(1 + i));
        }
        p.layers.relative_error[6] = std::numeric_limits<float>::infinity();
        return p;
    }

    std::string bytes(const std::string& path)
    {
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    /// The channels of an EXR, in the file's order.
    std::vector<std::string> channels(const std::string& path)
    {
        const Imf::InputFile file(path.c_str());
        std::vector<std::string> names;
        const auto& all = file.header().channels();
        for (auto c = all.begin(); c != all.end(); ++c) {
            names.emplace_back(c.name());
            EXPECT_EQ(c.channel().type, Imf::FLOAT) << c.name();
        }
        return names;
    }

    /// A channel of an EXR of 7 x 5 pixels.
    std::vector<float> channel(const std::string& path, const char* name)
    {
        Imf::InputFile file(path.c_str());
        const auto box = file.header().dataWindow();
        EXPECT_EQ(box, Imath::Box2i({0, 0}, {6, 4}));
        std::vector<float> values(35, -1.0f);
        Imf::FrameBuffer frame;
        frame.insert(
            name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float), 7 * sizeof(float)));
        file.setFrameBuffer(frame);
        file.readPixels(0, 4);
        return values;
    }

    TEST_F(image_file, exr_holds_layers)
    {
        const auto p = with_layers();
        write_image(path("a.exr"), p, 0, {{"seed", "7"}});
        EXPECT_EQ(channels(path("a.exr")),
            (std::vector<std::string>{"B", "G", "R", "estimate.count", "estimate.radius", "estimate.relative_error"}));
        EXPECT_EQ(channel(path("a.exr"), "estimate.radius"), p.layers.radius);
        EXPECT_EQ(channel(path("a.exr"), "estimate.count"), p.layers.count);
        EXPECT_EQ(channel(path("a.exr"), "estimate.relative_error"), p.layers.relative_error);
        const auto red = channel(path("a.exr"), "R");
        for (std::size_t i = 0; i < 35; ++i)
            EXPECT_EQ(red[i], p.pixels[i].x) << i;
        const Imf::InputFile file(path("a.exr").c_str());
        const auto* seed = file.header().findTypedAttribute<Imf::StringAttribute>("seed");
        ASSERT_NE(seed, nullptr);
        EXPECT_EQ(seed->value(), "7");

        const auto q = read_image(path("a.exr"));
        ASSERT_EQ(q.pixels.size(), p.pixels.size());
        EXPECT_EQ(std::memcmp(q.pixels.data(), p.pixels.data(), p.pixels.size() * sizeof(glm::vec3)), 0)
            << "layers do not disturb the picture";
        EXPECT_TRUE(q.layers.radius.empty() && q.layers.count.empty() && q.layers.relative_error.empty());
    }

    TEST_F(image_file, exr_holds_the_noise_of_several_passes)
    {
        film passes(7, 5, 1.0, true);
        const auto add = [&](std::uint32_t pass, float brightness) {
            pass_pixels p{{}, std::vector<glm::vec4>(35, glm::vec4(1)), std::vector<glm::vec4>(35)};
            for (int i = 0; i < 35; ++i)
                p.pixels.emplace_back(brightness * static_cast<float>(35 + i)); // below 4 of any neighbour's
            passes.add(pass, std::move(p));
        };
        add(0, 1);
        write_image(path("one.exr"), passes.picture().picture);
        EXPECT_EQ(channels(path("one.exr")),
            (std::vector<std::string>{"B", "G", "R", "estimate.count", "estimate.radius", "estimate.relative_error"}));

        add(1, 3);
        const auto two = passes.picture().picture;
        write_image(path("two.exr"), two);
        EXPECT_EQ(channels(path("two.exr")),
            (std::vector<std::string>{
                "B", "G", "R", "estimate.count", "estimate.radius", "estimate.relative_error", "noise"}));
        const auto noise = channel(path("two.exr"), "noise");
        EXPECT_EQ(noise, two.layers.noise);
        for (std::size_t i = 0; i < noise.size(); ++i) // b and 3 b: a mean of 2 b with a standard error of b
            EXPECT_FLOAT_EQ(noise[i], static_cast<float>(35 + i));
        EXPECT_EQ(channel(path("two.exr"), "G")[34], 138.0f);
    }

    TEST_F(image_file, layers_are_written_where_there_are_any)
    {
        EXPECT_TRUE(holds_layers("a.exr") && holds_layers("a.EXR"));
        EXPECT_FALSE(holds_layers("a.png") || holds_layers("a.pfm") || holds_layers("a") || holds_layers("exr"));
        write_image(path("a.exr"), gradient());
        EXPECT_EQ(channels(path("a.exr")), (std::vector<std::string>{"B", "G", "R"}));
        auto p = with_layers();
        p.layers.count.clear();
        write_image(path("a.exr"), p);
        EXPECT_EQ(channels(path("a.exr")),
            (std::vector<std::string>{"B", "G", "R", "estimate.radius", "estimate.relative_error"}));
        for (const auto* ending : {".png", ".pfm"}) {
            write_image(path(std::string("with") + ending), with_layers());
            write_image(path(std::string("without") + ending), gradient());
            EXPECT_EQ(bytes(path(std::string("with") + ending)), bytes(path(std::string("without") + ending)));
        }
    }

    TEST_F(image_file, rejects_layers_of_another_size)
    {
        auto p = with_layers();
        p.layers.count.pop_back();
        EXPECT_NE(refusal([&] {
            write_image(path("a.exr"), p);
        }).find("the layer estimate.count has 34 values for 35 pixels"),
            std::string::npos);
        EXPECT_EQ(files(), 0u);
    }

    TEST_F(image_file, pfm_has_the_bottom_row_first)
    {
        write_image(path("a.pfm"), {.width = 1, .height = 2, .pixels = {glm::vec3(1), glm::vec3(2)}});
        std::ifstream in(path("a.pfm"), std::ios::binary);
        const std::string all((std::istreambuf_iterator<char>(in)), {});
        ASSERT_EQ(all.size(), 12u + 24u);
        EXPECT_EQ(all.substr(0, 12), "PF\n1 2\n-1.0\n");
        float first = 0;
        std::memcpy(&first, all.data() + 12, sizeof first);
        EXPECT_EQ(first, 2.0f);
    }

    TEST_F(image_file, reads_big_endian_grey_pfm)
    {
        write_text(path("a.pfm"), std::string("Pf\n1 1\n2.0\n\x3f\x80\x00\x00", 15));
        EXPECT_EQ(read_image(path("a.pfm")).pixels.at(0), glm::vec3(2));
    }

    TEST_F(image_file, png_is_srgb)
    {
        const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
        const image p{.width = 2,
            .height = 2,
            .pixels = {{0.0f, 0.5f, 1.0f}, {0.001f, 2.0f, -1.0f}, {nan, inf, 0.2140411f}, {0.25f, 0.25f, 0.25f}}};
        write_image(path("a.png"), p);
        png_image png{};
        png.version = PNG_IMAGE_VERSION;
        ASSERT_TRUE(png_image_begin_read_from_file(&png, path("a.png").c_str())) << png.message;
        EXPECT_EQ(png.width, 2u);
        EXPECT_EQ(png.height, 2u);
        EXPECT_EQ(png.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
        EXPECT_EQ(png.flags & PNG_IMAGE_FLAG_COLORSPACE_NOT_sRGB, 0u);
        std::vector<unsigned char> bytes(PNG_IMAGE_SIZE(png));
        ASSERT_TRUE(png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr));
        EXPECT_EQ(bytes, (std::vector<unsigned char>{0, 188, 255, 3, 255, 0, 0, 255, 127, 137, 137, 137}));
        EXPECT_EQ(tone_mapped(0.25f, 1), 188);
        EXPECT_EQ(tone_mapped(0.25f, 2), 255);
        EXPECT_EQ(tone_mapped(0.5f, -1000), 0);
    }

    TEST(tone_map, equals_tone_mapped_bit_for_bit)
    {
        for (const double exposure : {0.0, 1.0, -3.7, 12.25, -64.0, 64.0}) {
            const tone_map fast(exposure);
            const float infinite = std::numeric_limits<float>::infinity();
            for (const float v :
                {0.0f, -0.0f, -1.0f, 1.0f, infinite, -infinite, std::numeric_limits<float>::quiet_NaN(),
                    std::numeric_limits<float>::min(), std::numeric_limits<float>::max()})
                ASSERT_EQ(fast(v), tone_mapped(v, exposure)) << v << " at " << exposure << " EV";
            float v = static_cast<float>(std::exp2(-exposure)) * 1e-4f;
            for (int i = 0; i < 100000; ++i, v *= 1.0001f)
                ASSERT_EQ(fast(v), tone_mapped(v, exposure)) << v << " at " << exposure << " EV";
        }
    }

} // namespace
} // namespace photongrid
