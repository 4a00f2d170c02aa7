// The command `error`: its sheet, its numbers and its refusals.
#pragma once

#include "program_under_test.hpp"

#include <limits>

namespace photongrid {
namespace {

    /// Pictures of 6 x 4 pixels: the reference is 2, and the picture is 3 at its left half.
    class program_error : public program {
    protected:
        program_error()
        {
            image reference{.width = 6, .height = 4, .pixels = std::vector<glm::vec3>(24, glm::vec3(2))};
            image picture = reference, lit{.width = 6, .height = 4, .pixels = std::vector<glm::vec3>(24)};
            for (std::size_t i = 0; i < 24; ++i)
                if (i % 6 < 3) {
                    picture.pixels[i] = glm::vec3(3);
                    lit.pixels[i] = glm::vec3(1);
                }
            write("reference.pfm", reference);
            write("picture.pfm", picture);
            write("lit.pfm", lit);
            write("black.pfm", {.width = 6, .height = 4, .pixels = std::vector<glm::vec3>(24)});
            write("other.pfm", {.width = 4, .height = 6, .pixels = std::vector<glm::vec3>(24)});
            picture.pixels[0] = reference.pixels[23] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
            write("holes.pfm", picture);
            write("reference_with_hole.pfm", reference);
            write("nowhere.pfm",
                {.width = 6,
                    .height = 4,
                    .pixels = std::vector<glm::vec3>(24, glm::vec3(std::numeric_limits<float>::quiet_NaN()))});
        }
        void write(const std::string& name, const image& picture) const
        {
            write_image((folder / name).string(), picture);
        }
        nlohmann::json stats() const { return nlohmann::json::parse(contents(folder / "stats.json")); }
        static nlohmann::json region(const nlohmann::json& all, const std::string& name)
        {
            for (const auto& r : all.at("regions"))
                if (r.at("name") == name)
                    return r;
            return {};
        }
    };

    TEST_F(program_error, draws_a_sheet_and_prints_statistics)
    {
        const auto e = run({"error", "picture.pfm", "reference.pfm", "--stats", "stats.json", "--region", "lit=lit.pfm",
            "--region", "unlit!=lit.pfm"});
        ASSERT_EQ(e.code, 0) << e.err;
        EXPECT_EQ(e.err, "");
        EXPECT_TRUE(e.out.ends_with("\npicture-error.png\n")) << e.out;
        const auto sheet = read_channels((folder / "picture-error.png").string());
        EXPECT_EQ(sheet.header.width, 3 * (240 + 4) + 4u);
        EXPECT_EQ(sheet.header.height, 2 * (160 + 23) + 4u);

        const auto found = stats();
        EXPECT_EQ(found.at("size"), nlohmann::json({6, 4}));
        EXPECT_EQ(found.at("not_finite"), 0);
        const double relmse = 1 / (2.01 * 2.01);
        const auto all = region(found, "all"), lit = region(found, "lit"), unlit = region(found, "unlit");
        EXPECT_NEAR(all.at("relmse").get<double>(), relmse / 2, 1e-9);
        EXPECT_NEAR(all.at("bias").get<double>(), 0.25, 1e-9);
        EXPECT_EQ(lit.at("pixels"), 12);
        EXPECT_NEAR(lit.at("relmse").get<double>(), relmse, 1e-9);
        EXPECT_NEAR(lit.at("share").get<double>(), 1, 1e-9);
        EXPECT_NEAR(lit.at("percentiles").at("100").get<double>(), 1 / 2.01, 1e-9);
        EXPECT_EQ(unlit.at("relmse"), 0);
        EXPECT_EQ(unlit.at("share"), 0);
        EXPECT_GT(lit.at("flip"), all.at("flip"));
        EXPECT_TRUE(region(found, "edges").at("relmse").is_null()) << "an even reference has none";
        std::uint64_t pixels = 0;
        for (const auto& bin : found.at("histogram"))
            pixels += bin.at("pixels").get<std::uint64_t>();
        EXPECT_EQ(pixels, 24u);
        const auto compared = run({"compare", "picture.pfm", "reference.pfm"}).out;
        const auto line
            = compared.substr(compared.find("relMSE  "), compared.find("\nlargest") - compared.find("relMSE"));
        EXPECT_NE(e.out.find(line + ";"), std::string::npos) << "as compare: " << line << '\n' << e.out;
    }

    TEST_F(program_error, writes_numbers_and_takes_averages)
    {
        const auto e = run({"error", "picture.pfm", "reference.pfm", "-o", "e.exr", "-o", "e.pfm"});
        ASSERT_EQ(e.code, 0) << e.err;
        EXPECT_TRUE(e.out.ends_with("\ne.exr\ne.pfm\n")) << e.out;
        EXPECT_EQ(e.out.find("colours of the sheet"), std::string::npos);
        for (const auto* name : {"e.exr", "e.pfm"}) {
            const auto numbers = read_image((folder / name).string());
            EXPECT_NEAR(numbers.pixels[0].x, 1 / 2.01, 1e-6);
            EXPECT_EQ(numbers.pixels[5].x, 0);
        }
        ASSERT_EQ(run({"error", "picture.pfm", "reference.pfm", "-o", "e.png", "--average", "2", "--region",
                          "lit=lit.pfm", "--stats", "stats.json"})
                      .code,
            0);
        EXPECT_EQ(stats().at("size"), nlohmann::json({3, 2}));
        EXPECT_NEAR(region(stats(), "all").at("relmse").get<double>(), (2 + 2 * 0.25) / (2.01 * 2.01) / 6, 1e-9);
        EXPECT_EQ(region(stats(), "lit").at("pixels"), 4);
    }

    TEST_F(program_error, skips_pixels_that_are_not_finite)
    {
        const auto e = run({"error", "holes.pfm", "reference_with_hole.pfm", "--stats", "stats.json", "-o", "e.png"});
        ASSERT_EQ(e.code, 0) << e.err;
        EXPECT_NE(e.out.find("skipped 2 pixels"), std::string::npos) << e.out;
        EXPECT_EQ(stats().at("not_finite"), 2);
        EXPECT_EQ(region(stats(), "all").at("pixels"), 22);
        EXPECT_NEAR(region(stats(), "all").at("relmse").get<double>(), 11 / (2.01 * 2.01) / 22, 1e-9);
        const auto sheet = read_channels((folder / "e.png").string());
        EXPECT_EQ(sheet.pixels[4 * sheet.header.width + 4 + 2 * 244], glm::vec4(0, 1, 0, 1));
        const auto none = run({"error", "nowhere.pfm", "reference.pfm", "-o", "none.png"});
        EXPECT_EQ(none.code, 1);
        EXPECT_EQ(none.err, "photongrid: error: no pixel is finite in both pictures\n");
        EXPECT_FALSE(fs::exists(folder / "none.png"));
        const auto equal = run({"error", "reference.pfm", "reference.pfm", "-o", "e.png", "--stats", "stats.json"});
        EXPECT_EQ(equal.code, 0) << equal.err;
        EXPECT_TRUE(region(stats(), "all").at("share").is_null());
    }

    TEST_F(program_error, refuses_what_cannot_be_compared)
    {
        const auto fails = [&](int code, const std::string& said, std::vector<std::string> arguments) {
            const auto before = files();
            arguments.insert(arguments.begin(), "error");
            const auto e = run(arguments);
            EXPECT_EQ(e.code, code) << e.err;
            EXPECT_NE(e.err.find(said), std::string::npos) << said << ": " << e.err;
            EXPECT_EQ(e.out, "");
            EXPECT_EQ(files(), before) << said;
        };
        fails(5, "the sizes differ: 6 x 4 and 4 x 6", {"picture.pfm", "other.pfm"});
        fails(5, "none.pfm", {"none.pfm", "reference.pfm"});
        fails(5, "picture.png: cannot be read", {"picture.png", "reference.pfm"});
        fails(5, "folder", {"picture.pfm", "reference.pfm", "-o", "no/folder.png"});
        fails(
            5, "other.pfm: --region c: the sizes differ", {"picture.pfm", "reference.pfm", "--region", "c=other.pfm"});
        fails(
            5, "black.pfm: --region c: no pixel is above", {"picture.pfm", "reference.pfm", "--region", "c=black.pfm"});
        fails(5, "lit.pfm: --region c: no pixel is above", {"picture.pfm", "reference.pfm", "--region", "c=lit.pfm,2"});
        fails(5, "has no block of 5 x 5", {"picture.pfm", "reference.pfm", "--average", "5"});
        for (const auto& wrong :
            std::vector<std::vector<std::string>>{{"--region", "caustics"}, {"--region", "=lit.pfm"},
                {"--region", "c="}, {"--region", "a b=lit.pfm"}, {"--region", "edges=lit.pfm"},
                {"--region", "c=lit.pfm", "--region", "c!=lit.pfm"}, {"--region", "c=lit.pfm,-1"},
                {"--region", "c=lit.pfm,x"}, {"--region", "c=lit.pfm,"}, {"--range", "1"}, {"--range", "1,0.1"},
                {"--range", "0,1"}, {"--range", "nan,1"}, {"--pixels-per-degree", "0"}, {"--pixels-per-degree", "nan"},
                {"--average", "0"}, {"--exposure", "x"}, {"-o", "picture.pfm"}, {"-o", "e.png", "--stats", "e.png"},
                {"--region", "c=lit.pfm", "--stats", "lit.pfm"}}) {
            auto arguments = std::vector<std::string>{"picture.pfm", "reference.pfm"};
            arguments.insert(arguments.end(), wrong.begin(), wrong.end());
            fails(2, wrong[wrong.size() - 2], arguments);
        }
        fails(2, "REFERENCE", {"picture.pfm"});
    }

} // namespace
} // namespace photongrid
