// Pictures that cannot be written or read, and comparison.
#pragma once

#include "image_under_test.hpp"

namespace photongrid {
namespace {

    TEST_F(image_file, rejects_paths_that_cannot_be_written)
    {
        const auto p = gradient();
        EXPECT_NE(
            refusal([&] { write_image(path("a.jpg"), p); }).find("expected .png, .exr or .pfm"), std::string::npos);
        EXPECT_NE(refusal([&] { write_image(path("none/a.png"), p); }).find("there is no folder"), std::string::npos);
        fs::create_directory(path("d.png"));
        EXPECT_NE(refusal([&] { check_image_path(path("d.png")); }).find("is a folder"), std::string::npos);
        EXPECT_NE(refusal([&] { write_file("/dev/null", ""); }).find("not a regular file"), std::string::npos);
        EXPECT_EQ(files(), 1u);
        EXPECT_EQ(refusal([&] { check_image_path(path("a.png")); }), "");
    }

    // A file-size limit simulates a full disk.
    TEST_F(image_file, a_failed_write_leaves_the_old_file)
    {
        write_text(path("a.pfm"), "old");
        image big{.width = 256, .height = 256, .pixels = std::vector<glm::vec3>(256 * 256)};
        rlimit old{};
        ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
        const rlimit small{.rlim_cur = 4096, .rlim_max = old.rlim_max};
        const auto handler = std::signal(SIGXFSZ, SIG_IGN);
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
        const auto said = refusal([&] { write_image(path("a.pfm"), big); });
        setrlimit(RLIMIT_FSIZE, &old);
        std::signal(SIGXFSZ, handler);
        EXPECT_NE(said.find("cannot be written: File too large"), std::string::npos) << said;
        EXPECT_EQ(files(), 1u);
        EXPECT_EQ(fs::file_size(path("a.pfm")), 3u);
    }

    TEST_F(image_file, writes_through_a_link)
    {
        write_text(path("real.pfm"), "old");
        fs::create_symlink(path("real.pfm"), path("link.pfm"));
        write_image(path("link.pfm"), gradient());
        EXPECT_TRUE(fs::is_symlink(path("link.pfm")));
        EXPECT_EQ(read_image(path("real.pfm")).width, 7u);
    }

    TEST_F(image_file, rejects_broken_files)
    {
        EXPECT_NE(refusal([&] { read_image(path("none.pfm")); }).find("No such file"), std::string::npos);
        EXPECT_NE(refusal([&] { read_image(path("none.exr")); }), "");
        EXPECT_NE(refusal([&] {
            write_image(path("a.png"), gradient());
            read_image(path("a.png"));
        }).find("cannot be measured"),
            std::string::npos);
        for (const auto* text : {"", "P6\n1 1\n255\n", "PF\n1 1\n", "PF\n-1 1\n-1.0\n", "PF\n0 1\n-1.0\n",
                 "PF\n60000 60000\n-1.0\n", "PF\n2 2\n-1.0\nabc", "PF\n2 2\n0\n"}) {
            write_text(path("bad.pfm"), text);
            EXPECT_NE(refusal([&] { read_image(path("bad.pfm")); }), "") << text;
            write_text(path("bad.exr"), text);
            EXPECT_NE(refusal([&] { read_image(path("bad.exr")); }), "") << text;
        }
        write_image(path("a.exr"), gradient());
        fs::resize_file(path("a.exr"), fs::file_size(path("a.exr")) / 2);
        EXPECT_NE(refusal([&] { read_image(path("a.exr")); }), "");
    }

    TEST(compare_images, measures)
    {
        const image a{.width = 2, .height = 1, .pixels = {{1, 1, 1}, {0.5f, 0, 0}}},
            b{.width = 2, .height = 1, .pixels = {{1, 1, 1}, {0, 0, 0}}};
        const auto d = compare_images(a, b);
        EXPECT_DOUBLE_EQ(d.mse, 0.25 / 6);
        EXPECT_DOUBLE_EQ(d.relmse, 0.25 / (0.01 * 0.01) / 6);
        EXPECT_DOUBLE_EQ(d.largest, 0.5);
        EXPECT_EQ(d.x, 1u);
        EXPECT_EQ(d.compared, 2u);
        EXPECT_EQ(compare_images(a, a).relmse, 0);
    }

    TEST(compare_images, skips_and_counts_what_is_not_finite)
    {
        auto a = gradient();
        const auto b = a; // one pixel is infinite
        a.pixels[7].x = std::numeric_limits<float>::quiet_NaN();
        const auto d = compare_images(a, b);
        EXPECT_EQ(d.not_finite, 2u);
        EXPECT_EQ(d.compared, 33u);
        EXPECT_EQ(d.mse, 0);
        EXPECT_THROW(compare_images(a, image{.width = 5, .height = 7, .pixels = b.pixels}), std::invalid_argument);
    }

    /// 128 x 128 pixels of a radiance, with Gaussian noise of a share of it.
    image noisy(double share, const std::function<double(std::uint32_t, std::uint32_t)>& radiance)
    {
        std::mt19937 bits(11);
        std::normal_distribution<double> gaussian(0, share);
        image p{.width = 128, .height = 128, .pixels = {}};
        for (std::uint32_t y = 0; y < p.height; ++y)
            for (std::uint32_t x = 0; x < p.width; ++x) {
                glm::dvec3 pixel(radiance(x, y));
                for (int c = 0; c < 3; ++c)
                    pixel[c] *= 1 + gaussian(bits);
                p.pixels.emplace_back(pixel);
            }
        return p;
    }

    TEST(picture_noise, is_the_relmse_against_a_perfect_picture)
    {
        const auto even = [](auto, auto) { return 3.0; };
        const auto slope = [](auto x, auto y) { return 20 + 0.05 * x + 0.1 * y; };
        const auto edges = [](auto x, auto y) { return x / 20 % 2 == y / 20 % 2 ? 1.0 : 8.0; };
        EXPECT_EQ(picture_noise(noisy(0, even)), 0);
        EXPECT_LT(picture_noise(noisy(0, slope)), 1e-12);
        for (const double share : {0.2, 0.03, 0.002}) {
            EXPECT_NEAR(
                picture_noise(noisy(share, even)) / compare_images(noisy(share, even), noisy(0, even)).relmse, 1, 0.05)
                << share;
            EXPECT_NEAR(picture_noise(noisy(share, slope)) / (share * share), 1, 0.07) << share;
            EXPECT_NEAR(picture_noise(noisy(share, edges)) / (share * share), 1, 0.7)
                << share; // edges in half the tiles
        }
    }

    TEST(noise_of_two, is_the_part_of_the_error_that_is_no_bias)
    {
        const auto radiance = [](auto x, auto y) { return x < 64 ? 5.0 : 1 + 0.01 * y; };
        const auto truth = noisy(0, radiance);
        auto a = noisy(0.1, radiance), other = a; // noise and, below, a bias of 20 %
        std::mt19937 bits(5);
        std::normal_distribution<float> gaussian(0, 0.1f);
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c)
                other.pixels[i][c] = truth.pixels[i][c] * (1 + gaussian(bits));
        for (auto* p : {&a, &other})
            for (auto& pixel : p->pixels)
                pixel *= 1.2f;
        EXPECT_NEAR(noise_of_two(a, other, truth), 0.0144, 0.0005);
        EXPECT_NEAR(compare_images(a, truth).relmse, 0.0144 + 0.04, 0.002);
        other.pixels[3].x = std::numeric_limits<float>::infinity();
        EXPECT_NEAR(noise_of_two(a, other, truth), 0.0144, 0.0005);
        EXPECT_THROW(
            noise_of_two(a, image{.width = 1, .height = 1, .pixels = {{1, 1, 1}}}, truth), std::invalid_argument);
    }

    TEST(picture_noise, leaves_out_what_is_not_finite)
    {
        auto p = noisy(0.1, [](auto, auto) { return 1.0; });
        const double before = picture_noise(p);
        p.pixels[70 * 128 + 5].y = std::numeric_limits<float>::infinity();
        EXPECT_NEAR(picture_noise(p) / before, 1, 0.02);
        EXPECT_TRUE(std::isnan(picture_noise({.width = 2, .height = 9, .pixels = std::vector<glm::vec3>(18)})));
    }

} // namespace
} // namespace photongrid
