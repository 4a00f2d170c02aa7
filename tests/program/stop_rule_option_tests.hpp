// --until-error, --percentile and --seconds.
#pragma once

#include "program_under_test.hpp"

namespace photongrid {
namespace {

    class program_with_stop_rules : public program {
    protected:
        nlohmann::json stats() const { return nlohmann::json::parse(contents(folder / "stats.json")); }
        /// Draws, and returns what --stats says of the picture.
        nlohmann::json picture_of(std::vector<std::string> options) const
        {
            options.insert(options.end(), {"--stats", "stats.json"});
            const auto e = run(small_with(options));
            EXPECT_EQ(e.code, 0) << e.err;
            return stats().at("picture");
        }
    };

    TEST_F(program_with_stop_rules, an_error_ends_a_picture_and_as_many_passes_have_its_bytes)
    {
        const auto end = picture_of({"--until-error", "0.5", "-o", "error.pfm"});
        EXPECT_EQ(end.at("ended_by"), "error");
        EXPECT_EQ(end.at("percentile"), 0.95);
        EXPECT_LE(end.at("error").get<double>(), 0.5);
        const auto passes = end.at("passes").get<unsigned>();
        ASSERT_GE(passes, 4u);
        const auto counted
            = picture_of({"--passes", std::to_string(passes), "--report-bias", "yes", "-o", "passes.pfm"});
        EXPECT_EQ(contents(folder / "error.pfm"), contents(folder / "passes.pfm"));
        EXPECT_EQ(counted.at("ended_by"), "passes");
        EXPECT_EQ(counted.at("error"), end.at("error"));

        // A percentile of fewer pixels is reached sooner, and a limit is kept.
        EXPECT_LT(picture_of({"--until-error", "0.5", "--percentile", "0.5"}).at("passes").get<unsigned>(), passes);
        const auto limited = picture_of({"--until-error", "0.5", "--passes", std::to_string(passes - 1)});
        EXPECT_EQ(limited.at("passes"), passes - 1);
        EXPECT_EQ(limited.at("ended_by"), "passes");
        EXPECT_GT(limited.at("error").get<double>(), 0.5);

        const auto single = picture_of({});
        EXPECT_EQ(single.at("passes"), 1);
        EXPECT_TRUE(single.at("error").is_null()) << "one pass has no spread";
        for (const auto& wrong : {"--until-error", "--percentile", "--seconds"})
            EXPECT_EQ(run(small_with({wrong, "-1"})).code, 2) << wrong;
    }

    TEST_F(program_with_stop_rules, exact_pictures_end_by_a_rule_or_a_number_of_passes)
    {
        const auto draw = [&](std::vector<std::string> options) {
            options.insert(options.begin(),
                {"render", ring, "--backend", "serial", "--size", "16x12", "--photons", "300", "--gather-rays", "1",
                    "--exact", "--stats", "stats.json", "-o", "a.pfm"});
            const auto e = run(options);
            EXPECT_EQ(e.code, 0) << e.err;
            return stats();
        };
        const auto three = draw({"--passes", "3"});
        EXPECT_EQ(three.at("picture").at("passes"), 3);
        EXPECT_EQ(three.at("settings").at("indirect"), "paths");
        EXPECT_EQ(three.at("settings").at("radii"), "shrinking");
        EXPECT_EQ(three.at("settings").at("k"), 50);
        EXPECT_EQ(draw({"--passes", "2", "--k", "8"}).at("settings").at("k"), 8);
        EXPECT_EQ(draw({"--until-error", "0.9"}).at("picture").at("ended_by"), "error");
        EXPECT_EQ(run({"render", ring, "--exact", "--as-paper", "-o", "a.pfm"}).code, 2);
    }

    /// A scene's limit holds for its own rule, and not for one of the command line.
    TEST_F(program_with_stop_rules, scenes_have_an_error_to_reach)
    {
        auto scene = nlohmann::json::parse(contents(ring));
        auto& render = scene.at("render");
        const auto draw = [&](std::vector<std::string> options) {
            std::ofstream(folder / "scene.json") << scene;
            options.insert(options.begin(),
                {"render", "scene.json", "--backend", "serial", "--size", "16x12", "--photons", "300", "--k", "16",
                    "--stats", "stats.json", "-o", "a.pfm"});
            const auto e = run(options);
            EXPECT_EQ(e.code, 0) << e.err;
            return stats().at("picture");
        };
        render["until_error"] = 0.99;
        EXPECT_EQ(draw({}).at("ended_by"), "error");
        EXPECT_GE(draw({}).at("passes").get<unsigned>(), 4u);
        EXPECT_EQ(draw({"--until-error", "0"}).at("passes"), 1);
        EXPECT_EQ(draw({"--as-paper"}).at("passes"), 1);
        render["passes"] = 3;
        EXPECT_EQ(draw({}).at("passes"), 3);
        EXPECT_EQ(draw({"--until-error", "0"}).at("passes"), 3);
        EXPECT_GE(draw({"--until-error", "0.98"}).at("passes").get<unsigned>(), 4u);
        EXPECT_GE(draw({"--exact", "--gather-rays", "1"}).at("passes").get<unsigned>(), 4u);
        EXPECT_EQ(draw({"--interpolation", "0.3", "--percentile", "0.5"}).at("passes"), 3) << "no rules";
        render["seconds"] = 3;
        std::ofstream(folder / "scene.json") << scene;
        EXPECT_EQ(run({"check", "scene.json"}).code, 3) << "a scene's picture would depend on the machine";
    }

    TEST_F(program_with_stop_rules, time_ends_a_picture_and_as_many_passes_have_its_bytes)
    {
        const auto end = picture_of({"--seconds", "1", "--spp", "2", "-o", "time.pfm", "-o", "time.exr"});
        const auto passes = end.at("passes").get<unsigned>();
        if (passes < 65536) {
            EXPECT_EQ(end.at("ended_by"), "seconds");
        }
        if (passes > 0) {
            picture_of({"--passes", std::to_string(passes), "--spp", "2", "-o", "passes.pfm"});
            EXPECT_EQ(contents(folder / "time.pfm"), contents(folder / "passes.pfm"));
        }
        EXPECT_NE(contents(folder / "time.exr").find("passes"), std::string::npos) << "the picture says how many";

        // A first pass of minutes: what there is of it.
        const auto e
            = run(small_with({"--seconds", "0.5", "--spp", "65536", "-o", "part.pfm", "--stats", "stats.json"}));
        EXPECT_EQ(e.code, 0) << e.err;
        EXPECT_NE(e.err.find("no pass ended within 0.5 s"), std::string::npos) << e.err;
        EXPECT_EQ(stats().at("picture").at("passes"), 0);
        EXPECT_EQ(stats().at("picture").at("ended_by"), "seconds");
        EXPECT_GT(read_image((folder / "part.pfm").string()).pixels.size(), 0u);
    }

    TEST_F(program_with_stop_rules, a_smaller_error_goes_on_from_the_file)
    {
        picture_of({"--until-error", "0.3", "-o", "whole.pfm"});
        const auto first = picture_of({"--until-error", "0.5", "--resume", "unfinished", "-o", "a.pfm"});
        EXPECT_TRUE(fs::exists(folder / "unfinished")) << "it may go on";
        EXPECT_EQ(picture_of({"--until-error", "0.5", "--resume", "unfinished", "-o", "a.pfm"}), first)
            << "nothing to do";
        const auto e = run(small_with({"--until-error", "0.3", "--resume", "unfinished", "-o", "a.pfm"}));
        EXPECT_EQ(e.code, 0) << e.err;
        EXPECT_NE(e.err.find("goes on from unfinished"), std::string::npos) << e.err;
        EXPECT_EQ(contents(folder / "a.pfm"), contents(folder / "whole.pfm"));
        // The time of all runs counts, and --quiet says nothing.
        const auto late = run(small_with(
            {"--seconds", "0.000001", "--report-bias", "yes", "--resume", "unfinished", "-o", "b.pfm", "--quiet"}));
        EXPECT_EQ(late.code, 0);
        EXPECT_EQ(late.err, "");
        EXPECT_EQ(contents(folder / "b.pfm"), contents(folder / "whole.pfm"));
        EXPECT_EQ(run(small_with({"--until-error", "0.2", "--seed", "2", "--resume", "unfinished"})).code, 5);
    }

} // namespace
} // namespace photongrid
