// Options of the estimate.
#pragma once

#include "program_under_test.hpp"

namespace photongrid {
namespace {

    TEST_F(program, rejects_wrong_leak_policies)
    {
        const std::string list = "expected none, or some of side, min_cosine, min_cosine=COS, flattening, flattening=F "
                                 "with commas between them";
        for (const auto& [given, expected] :
            std::vector<std::pair<std::string, std::string>>{{"walls", "\"walls\" given; " + list},
                {"side,", "\"\" given; " + list}, {"", list}, {",side", "\"\" given; " + list},
                {"side=1", "\"side=1\" given; " + list}, {"side, disc", "\" disc\" given; " + list},
                {"none,side", "expected none alone"}, {"side,none", "expected none alone"}, {"none=0", list},
                {"side,side", "has side twice"}, {"flattening,flattening=4", "has flattening twice"},
                {"min_cosine=", "expected min_cosine=COS, a cosine from -1 to 1"},
                {"min_cosine=1.1", "\"1.1\" given; expected min_cosine=COS"},
                {"min_cosine=nan", "expected min_cosine=COS"}, {"min_cosine=half", "expected min_cosine=COS"},
                {"flattening=0.9", "\"0.9\" given; expected flattening=F, a ratio from 1 to 1e6"},
                {"flattening=1e300", "expected flattening=F"}, {"flattening=4=4", "expected flattening=F"}}) {
            const auto e = run(small_with({"--leaks", given}));
            EXPECT_EQ(e.code, 2) << given;
            EXPECT_NE(e.err.find("--leaks"), std::string::npos) << given << ": " << e.err;
            EXPECT_NE(e.err.find(expected), std::string::npos) << given << ": " << e.err;
        }
        EXPECT_EQ(files(), 0u);
    }

    using nlohmann::json;

    // Settings of the estimate, as the statistics have them.
    const json by_default = json::parse(
        R"({"search": "exact_k", "filter": "silverman", "bias": "unbiased", "leaks": {"side": true, "min_cosine": 0.5}, "edge_correction": "probes", "only": "all", "surplus": "photons", "emission": "guided"})");
    const json paper = json::parse(
        R"({"search": "at_least_k", "filter": "constant", "bias": "paper", "leaks": {}, "edge_correction": "none", "only": "all", "surplus": "power", "emission": "power"})");
    json but(json all, const char* more)
    {
        all.update(json::parse(more));
        return all;
    }

    /// Settings of a scene of these tests. Lengths are in m there and in statistics.
    const char* const of_scene
        = R"({"search": "fixed_radius", "filter": "silverman", "bias": "paper", "leaks": {"min_cosine": 0.25, "flattening": 3}, "edge_correction": "polygons"})";
    /// Writes the ring's scene with these settings.
    void write_scene_with_estimate(const fs::path& ring, const fs::path& path)
    {
        auto scene = json::parse(contents(ring), nullptr, true, true);
        scene["render"].update(json::parse(of_scene));
        std::ofstream(path) << scene;
    }

    TEST_F(program, options_set_the_estimate)
    {
        struct row {
            std::vector<std::string> options;
            json settings; ///< some of those in the statistics
        };
        const std::vector<row> rows{
            {{}, by_default},
            {{"--search", "at_least_k"}, but(by_default, R"({"search": "at_least_k"})")},
            {{"--search", "fixed_radius", "--filter", "cone"},
                but(by_default, R"({"search": "fixed_radius", "filter": "cone"})")},
            {{"--filter", "epanechnikov"}, but(by_default, R"({"filter": "epanechnikov"})")},
            {{"--filter", "silverman", "--bias", "paper"},
                but(by_default, R"({"filter": "silverman", "bias": "paper"})")},
            {{"--leaks", "none"}, but(by_default, R"({"leaks": {}})")},
            {{"--leaks", "side"}, but(by_default, R"({"leaks": {"side": true}})")},
            {{"--leaks", "min_cosine"}, but(by_default, R"({"leaks": {"min_cosine": 0.5}})")},
            {{"--leaks", "flattening"}, but(by_default, R"({"leaks": {"flattening": 4}})")},
            {{"--leaks", "flattening=2.5,side,min_cosine=-0.3"},
                but(by_default, R"({"leaks": {"side": true, "min_cosine": -0.3, "flattening": 2.5}})")},
            {{"--leaks", "min_cosine=-1,flattening=1"}, but(by_default, R"({"leaks": {}})")},
            {{"--edge-correction", "none"}, but(by_default, R"({"edge_correction": "none"})")},
            {{"--edge-correction", "probes"}, by_default},
            {{"--leaks", "min_cosine", "--edge-correction", "polygons"},
                but(by_default, R"({"leaks": {"min_cosine": 0.5}, "edge_correction": "polygons"})")},
            {{"--as-paper", "--edge-correction", "polygons", "--leaks", "side,min_cosine=0.2"},
                but(paper, R"({"leaks": {"side": true, "min_cosine": 0.2}, "edge_correction": "polygons"})")},
            {{"--only", "direct"}, but(by_default, R"({"only": "direct"})")},
            {{"--only", "caustic"}, but(by_default, R"({"only": "caustic"})")},
            {{"--only", "indirect"}, but(by_default, R"({"only": "indirect"})")},
            {{"--surplus", "power"}, but(by_default, R"({"surplus": "power"})")},
            {{"--as-paper"}, paper},
            {{"--emission", "power"}, but(by_default, R"({"emission": "power"})")},
            {{"--caustic-k", "7"}, but(by_default, R"({"caustic_photons": 0, "caustic_k": 7})")},
            {{"--as-paper", "--surplus", "photons"}, but(paper, R"({"surplus": "photons"})")},
            {{"--filter", "cone", "--as-paper", "--leaks", "side"},
                but(paper, R"({"filter": "cone", "leaks": {"side": true}})")},
            {{"--as-paper", "--search", "exact_k", "--bias", "unbiased", "--only", "caustic"},
                but(paper, R"({"search": "exact_k", "bias": "unbiased", "only": "caustic"})")},
        };
        for (const auto& [options, settings] : rows) {
            auto arguments = small_with({"--stats", "stats.json"});
            arguments.insert(arguments.end(), options.begin(), options.end());
            expect_settings(arguments, settings);
        }
    }

    TEST_F(program, options_override_the_scenes_estimate)
    {
        write_scene_with_estimate(ring, folder / "own.json");
        auto arguments = small_with({"--stats", "stats.json", "-o", "a.exr"});
        arguments[1] = "own.json";
        const auto own = but(by_default, of_scene);
        expect_settings(arguments, own);
        EXPECT_NE(
            contents(folder / "a.exr")
                .find(
                    R"("search":"fixed_radius","filter":"silverman","bias":"paper","leaks":{"min_cosine":0.25,"flattening":3.0},"edge_correction":"polygons","indirect":"map","gather_rays":16,"radii":"shrinking","interpolation":0.5,"report_bias":"auto","only":"all")"),
            std::string::npos)
            << "the EXR's note";
        arguments.insert(arguments.end(), {"--filter", "cone", "--leaks", "side", "--edge-correction", "none"});
        expect_settings(
            arguments, but(own, R"({"filter": "cone", "leaks": {"side": true}, "edge_correction": "none"})"));
        arguments.emplace_back("--as-paper");
        expect_settings(arguments, but(paper, R"({"filter": "cone", "leaks": {"side": true}})"));
    }

    TEST_F(program, a_leak_policy_that_edge_correction_needs_cannot_be_taken_away)
    {
        write_scene_with_estimate(ring, folder / "own.json");
        auto arguments = small_with({"--leaks", "side", "-o", "a.exr"});
        arguments[1] = "own.json";
        const auto e = run(arguments);
        EXPECT_EQ(e.code, 2);
        EXPECT_NE(e.err.find("on the command line: edge_correction: photons of adjoining walls would count"),
            std::string::npos)
            << e.err;
        EXPECT_NE(e.err.find("needs the leak policy min_cosine above 0"), std::string::npos) << e.err;
        EXPECT_FALSE(fs::exists(folder / "a.exr"));
    }

    TEST_F(program, layers_need_a_file_that_holds_them)
    {
        for (const auto& outputs :
            std::vector<std::vector<std::string>>{{}, {"-o", "a.png"}, {"-o", "a.pfm", "-o", "exr"}}) {
            auto arguments = small_with({"--aov"});
            arguments.insert(arguments.end(), outputs.begin(), outputs.end());
            const auto e = run(arguments);
            EXPECT_EQ(e.code, 2);
            EXPECT_NE(e.err.find("--aov: "), std::string::npos) << e.err;
            EXPECT_NE(e.err.find("expected an EXR picture, which holds layers: -o OUT.exr"), std::string::npos)
                << e.err;
        }
        EXPECT_EQ(files(), 0u);
        const auto e = run(small_with({"--aov", "-o", "a.png", "-o", "a.EXR"}));
        EXPECT_EQ(e.code, 0) << e.err;
        ASSERT_EQ(run(small_with({"-o", "b.png", "-o", "b.exr"})).code, 0);
        EXPECT_EQ(contents(folder / "a.png"), contents(folder / "b.png")) << "layers do not change the picture";
        EXPECT_EQ(contents(folder / "b.exr").find("estimate."), std::string::npos);
    }

    TEST_F(program, caustic_photons_have_a_map_of_their_own)
    {
        const auto photons = [&](std::vector<std::string> more) {
            std::vector<std::string> arguments{"render", ring, "--backend", "serial", "--size", "16x12", "--photons",
                "300", "--caustic-photons", "400", "--caustic-k", "20", "--stats", "stats.json"};
            arguments.insert(arguments.end(), more.begin(), more.end());
            EXPECT_EQ(run(arguments).code, 0);
            const auto s = json::parse(contents(folder / "stats.json"));
            EXPECT_GT(s.at("estimate").at("mean_count"), 1); // most of the table gets no caustic
            return s.at("photons");
        };
        const auto apart = photons({});
        EXPECT_EQ(apart.at("stored"), 400); // the ring throws no other light
        EXPECT_GT(apart.at("left_to_caustics"), 0);
        const auto paths = [](const json& p) { return p.at("emitted").get<double>(); };
        EXPECT_GT(
            paths(photons({"--only", "caustic", "--emission", "power"})), 5 * paths(photons({"--only", "caustic"})));
    }

    TEST_F(program, parts_of_the_light_add_up)
    {
        // With a given radius and a constant kernel an estimate is linear in the photons.
        const std::string box = PHOTONGRID_SCENES "/cornell_box.json";
        const auto draw = [&](std::vector<std::string> more) {
            std::vector<std::string> arguments{"render", box, "--backend", "serial", "--size", "32x32", "--photons",
                "4000", "--caustic-photons", "0", "--passes", "2", "--spp", "1", "--light-samples", "2", "--k", "10",
                "--search", "fixed_radius", "--max-radius", "0.2", "--filter", "constant", "--stats", "s.json", "-o",
                "a.exr"};
            arguments.insert(arguments.end(), more.begin(), more.end());
            const auto e = run(arguments);
            EXPECT_EQ(e.code, 0) << e.err;
            const auto s = nlohmann::json::parse(contents(folder / "s.json"));
            return std::pair(read_image(folder / "a.exr"), s.at("map").at("left_out").get<std::uint64_t>());
        };
        const auto [all, none_left_out] = draw({});
        const auto [direct, ignored] = draw({"--only", "direct"});
        const auto [caustic, others] = draw({"--only", "caustic"});
        const auto [indirect, caustics] = draw({"--only", "indirect"});
        EXPECT_EQ(none_left_out, 0u);
        EXPECT_EQ(others + caustics, 4000u);
        EXPECT_GT(caustics, 100u);
        EXPECT_GT(others, 1000u);
        for (std::size_t i = 0; i < all.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(direct.pixels[i][c] + caustic.pixels[i][c] + indirect.pixels[i][c], all.pixels[i][c],
                    1e-5f * all.pixels[i][c] + 1e-7f)
                    << i;
    }

    TEST_F(program, writes_layers)
    {
        ASSERT_EQ(run(small_with({"--aov", "-o", "a.exr"})).code, 0);
        for (const auto* channel : {"estimate.radius", "estimate.count", "estimate.relative_error"})
            EXPECT_NE(contents(folder / "a.exr").find(channel), std::string::npos) << channel;
    }

} // namespace
} // namespace photongrid
