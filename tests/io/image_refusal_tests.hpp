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
        EXPECT_NE(refusal([&] { read_image(path("a.png")); }).find("expected .exr or .pfm"), std::string::npos);
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

} // namespace
} // namespace photongrid
