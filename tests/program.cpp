// The program from outside: what it prints, writes and returns.
#include "image_file.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace photongrid {
namespace {

    namespace fs = std::filesystem;

    struct ended {
        int code = -1; ///< -1: ended by a signal
        std::string out, err;
    };

    std::string contents(const fs::path& path)
    {
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    /// Runs the program in a folder of its own.
    class program : public ::testing::Test {
    protected:
        program() : folder(fs::temp_directory_path() / ("photongrid_program_" + std::to_string(::getpid())))
        {
            fs::create_directories(folder);
        }
        ~program() override { fs::remove_all(folder); }

        pid_t start(std::vector<std::string> arguments) const
        {
            arguments.insert(arguments.begin(), PHOTONGRID_PROGRAM);
            std::vector<char*> argv;
            for (auto& a : arguments)
                argv.push_back(a.data());
            argv.push_back(nullptr);
            const pid_t child = ::fork();
            if (child == 0) {
                const auto send = [&](const char* name, int to) {
                    ::dup2(::open((folder.string() + name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), to);
                };
                send(".out", 1);
                send(".err", 2);
                if (::chdir(folder.c_str()) == 0)
                    ::execv(argv[0], argv.data());
                ::_exit(127);
            }
            return child;
        }
        ended wait(pid_t child) const
        {
            int status = 0;
            ::waitpid(child, &status, 0);
            ended e{.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
                .out = contents(folder.string() + ".out"),
                .err = contents(folder.string() + ".err")};
            fs::remove(folder.string() + ".out");
            fs::remove(folder.string() + ".err");
            return e;
        }
        ended run(std::vector<std::string> arguments) const { return wait(start(std::move(arguments))); }
        std::size_t files() const
        {
            return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
        }

        fs::path folder;
        const std::string ring = PHOTONGRID_SCENES "/ring.json";
        /// Small enough for every test run.
        const std::vector<std::string> small{"render", ring, "--backend", "serial", "--size", "32x24", "--photons",
            "300", "--k", "16", "--grid", "32,1,32"};
        std::vector<std::string> small_with(std::vector<std::string> more) const
        {
            more.insert(more.begin(), small.begin(), small.end());
            return more;
        }
    };

    TEST_F(program, helps)
    {
        const auto help = run({"--help"});
        EXPECT_EQ(help.code, 0);
        for (const auto* word : {"render", "view", "compare", "check", "devices", "Exit codes", "130"})
            EXPECT_NE(help.out.find(word), std::string::npos) << word;
        const auto render = run({"render", "--help"});
        EXPECT_EQ(render.code, 0);
        for (const auto* option :
            {"--backend", "--device", "--map", "--slots", "--photons", "--k", "--grid", "--max-radius", "--size",
                "--spp", "--light-samples", "--depth", "--seed", "--exposure", "-o", "--search", "--kernel", "--bias",
                "--leaks", "--edge-correction", "--only", "--aov", "--as-paper", "--stats", "--shader-cache",
                "--time-passes", "--progressive", "--every", "--strip", "--crop", "--reference", "--resume", "--quiet"})
            EXPECT_NE(render.out.find(option), std::string::npos) << option;
        const auto version = run({"--version"});
        EXPECT_EQ(version.code, 0);
        EXPECT_EQ(version.out.substr(0, 11), "photongrid ");
    }

    TEST_F(program, refuses_wrong_command_lines)
    {
        EXPECT_EQ(run({}).code, 2);
        EXPECT_EQ(run({"draw"}).code, 2);
        EXPECT_EQ(run({"render"}).code, 2);
        for (const auto& wrong :
            std::vector<std::vector<std::string>>{{"--backend", "cuda"}, {"--size", "32"}, {"--size", "32x-4"},
                {"--size", "0x4"}, {"--grid", "1,2"}, {"--grid", "1,2,3,4"}, {"--grid", "0,1,1"}, {"--photons", "1e3"},
                {"--photons", "-1"}, {"--photons", "99999999999"}, {"--k", "0"}, {"--max-radius", "nan"},
                {"--max-radius", "-1"}, {"--exposure", "inf"}, {"--slots", "17"}, {"--map", "hash"}, {"--device", "0"},
                {"--time-passes"}, {"--spp", "0"}, {"--nonsense"}, {"--search", "exact"}, {"--kernel", "gauss"},
                {"--bias", "none"}, {"--edge-correction", "disks"}, {"--edge-correction"}, {"--only", "all"},
                {"--only", "caustics"}, {"--as-paper", "--as-paper=maybe"}}) {
            const auto e = run([&] {
                auto all = small;
                // An option given twice is an error of its own.
                for (std::size_t i = 2; i + 1 < all.size();)
                    if (all[i] == wrong[0])
                        all.erase(all.begin() + static_cast<std::ptrdiff_t>(i),
                            all.begin() + static_cast<std::ptrdiff_t>(i) + 2);
                    else
                        i += 2;
                all.insert(all.end(), wrong.begin(), wrong.end());
                return all;
            }());
            EXPECT_EQ(e.code, 2) << wrong[0] << ": " << e.err;
            EXPECT_NE(e.err, "");
        }
        EXPECT_EQ(files(), 0u);
    }

    TEST_F(program, checks_scenes)
    {
        for (const auto* name : {"ring", "glass_ball", "cornell_box", "cornell_blocks"})
            EXPECT_EQ(run({"check", PHOTONGRID_SCENES + std::string("/") + name + ".json"}).code, 0);
        std::ofstream(folder / "bad.json") << "{\"photongrid\": 1,\n \"lihgts\": []}";
        const auto e = run({"check", "bad.json"});
        EXPECT_EQ(e.code, 3);
        EXPECT_EQ(e.err, "bad.json:2:2: error: unknown key \"lihgts\" in \"scene\"; expected \"lights\"?\n");
        EXPECT_EQ(run({"render", "bad.json"}).code, 3);
        EXPECT_EQ(run({"check", "none.json"}).code, 3);
    }

    TEST_F(program, lists_devices)
    {
        const auto e = run({"devices"});
        EXPECT_EQ(e.code, 0);
        for (const auto* name : {"serial  ", "gl  ", "gl-osmesa  ", "vulkan  "})
            EXPECT_NE(("\n" + e.out).find(std::string("\n") + name), std::string::npos) << e.out;
    }

    TEST_F(program, same_seed_same_bytes)
    {
        const auto first = run(small_with({"-o", "a.png", "-o", "a.exr", "-o", "a.pfm"}));
        ASSERT_EQ(first.code, 0) << first.err;
        EXPECT_EQ(first.out, "a.png\na.exr\na.pfm\n");
        EXPECT_EQ(first.err, "") << "no terminal, no progress bar";
        ASSERT_EQ(run(small_with({"-o", "b.png", "-o", "b.exr", "-o", "b.pfm"})).code, 0);
        for (const auto* ending : {".png", ".exr", ".pfm"})
            EXPECT_EQ(contents(folder / (std::string("a") + ending)), contents(folder / (std::string("b") + ending)));
        ASSERT_EQ(run(small_with({"-o", "c.pfm", "--seed", "2"})).code, 0);
        EXPECT_NE(contents(folder / "a.pfm"), contents(folder / "c.pfm"));
        for (const auto* note : {"serial", "seed", "photongrid ", "max_radius"})
            EXPECT_NE(contents(folder / "a.exr").find(note), std::string::npos) << note;

        EXPECT_EQ(run({"compare", "a.exr", "a.pfm", "--max-relmse", "0"}).code, 0);
        const auto differs = run({"compare", "c.pfm", "a.pfm", "--max-relmse", "1e-12"});
        EXPECT_EQ(differs.code, 1);
        EXPECT_NE(differs.out.find("relMSE"), std::string::npos);
        EXPECT_EQ(run({"compare", "c.pfm", "a.pfm"}).code, 0);
        EXPECT_EQ(run({"compare", "a.png", "a.pfm"}).code, 5);
        EXPECT_EQ(run({"compare", "a.pfm", "none.pfm"}).code, 5);
        write_image((folder / "other.pfm").string(), {.width = 1, .height = 1, .pixels = {glm::vec3(1)}});
        EXPECT_EQ(run({"compare", "a.pfm", "other.pfm"}).code, 5);
    }

    TEST_F(program, names_the_picture_after_the_scene)
    {
        const auto e = run(small);
        EXPECT_EQ(e.code, 0) << e.err;
        EXPECT_EQ(e.out, "ring.png\n");
        EXPECT_TRUE(fs::exists(folder / "ring.png"));
        EXPECT_EQ(files(), 1u);
    }

    TEST_F(program, fits_the_grid_when_asked)
    {
        auto fitted = small_with({"--stats", "stats.json", "-o", "a.pfm"});
        std::replace(fitted.begin(), fitted.end(), std::string("32,1,32"), std::string("auto"));
        ASSERT_EQ(run(fitted).code, 0);
        const auto s = nlohmann::json::parse(contents(folder / "stats.json"));
        EXPECT_EQ(s.at("settings").at("grid"), "auto");
        const auto& resolution = s.at("map").at("resolution");
        ASSERT_EQ(resolution.size(), 3u);
        EXPECT_EQ(resolution[0].get<unsigned>() * resolution[1].get<unsigned>() * resolution[2].get<unsigned>(),
            s.at("map").at("cells"));
        EXPECT_GT(s.at("map").at("cells"), 1);
        ASSERT_EQ(run(small_with({"-o", "b.pfm"})).code, 0);
        EXPECT_EQ(run({"compare", "a.pfm", "b.pfm", "--max-relmse", "1e-6"}).code, 0)
            << "the grid does not change what exact_k finds";
    }

    TEST_F(program, renders_on_threads)
    {
        auto with_backend = [&](std::vector<std::string> more) {
            auto all = small_with(std::move(more));
            for (auto& word : all)
                if (word == "serial")
                    word = "cpu";
            return all;
        };
        const auto e = run(with_backend({"-o", "one.pfm", "--threads", "1"}));
        if (e.code == 4 && e.err.find("built without the cpu backend") != std::string::npos)
            GTEST_SKIP() << e.err;
        ASSERT_EQ(e.code, 0) << e.err;
        ASSERT_EQ(run(with_backend({"-o", "three.pfm", "--threads", "3", "--stats", "stats.json"})).code, 0);
        EXPECT_EQ(contents(folder / "one.pfm"), contents(folder / "three.pfm"));
        EXPECT_EQ(nlohmann::json::parse(contents(folder / "stats.json")).at("backend"), "cpu");
        ASSERT_EQ(run(small_with({"-o", "serial.pfm"})).code, 0);
        EXPECT_EQ(run({"compare", "one.pfm", "serial.pfm", "--max-relmse", "1e-10"}).code, 0);
        EXPECT_EQ(run(with_backend({"--threads", "5000"})).code, 2);
    }

    TEST_F(program, keeps_compiled_kernels_where_asked)
    {
        auto on_vulkan = [&](std::vector<std::string> more) {
            auto all = small_with(std::move(more));
            for (auto& word : all)
                if (word == "serial")
                    word = "vulkan";
            return run(all);
        };
        const auto kept = [&] {
            return fs::exists(folder / "cache")
                ? std::distance(fs::directory_iterator(folder / "cache"), fs::directory_iterator())
                : 0;
        };
        const auto e = on_vulkan({"-o", "none.pfm", "--shader-cache", "none"});
        if (e.code == 4 && std::getenv("PHOTONGRID_REQUIRE_BACKENDS") == nullptr)
            GTEST_SKIP() << e.err;
        ASSERT_EQ(e.code, 0) << e.err;
        EXPECT_EQ(files(), 1u);
        ASSERT_EQ(on_vulkan({"-o", "first.pfm", "--shader-cache", "cache"}).code, 0);
        const auto files_then = kept();
        EXPECT_GT(files_then, 10);
        ASSERT_EQ(
            on_vulkan({"-o", "second.pfm", "--shader-cache", "cache", "--time-passes", "--stats", "stats.json"}).code,
            0);
        EXPECT_EQ(kept(), files_then); // nothing was compiled anew
        const auto stats = nlohmann::json::parse(contents(folder / "stats.json"));
        EXPECT_TRUE(stats.contains("compile_ms"));
        EXPECT_GT(stats.at("kernels").at("bounce_photon").at("ms"), 0);
        EXPECT_EQ(contents(folder / "none.pfm"), contents(folder / "first.pfm"));
        EXPECT_EQ(contents(folder / "none.pfm"), contents(folder / "second.pfm"));
    }

    TEST_F(program, refuses_outputs_before_rendering)
    {
        EXPECT_EQ(run(small_with({"-o", "a.jpg"})).code, 5);
        EXPECT_EQ(run(small_with({"-o", "none/a.png"})).code, 5);
        EXPECT_EQ(run(small_with({"-o", "a.png", "--stats", "none/a.json"})).code, 5);
        EXPECT_EQ(files(), 0u);
    }

    TEST_F(program, accounts_for_every_photon)
    {
        for (const auto* map : {"sort", "route"}) {
            SCOPED_TRACE(map);
            ASSERT_EQ(run(small_with({"--stats", "stats.json", "--map", map, "--max-radius", "0.2"})).code, 0);
            const auto s = nlohmann::json::parse(contents(folder / "stats.json"));
            EXPECT_EQ(s.at("scene"), "ring");
            EXPECT_EQ(s.at("backend"), "serial");
            EXPECT_NE(s.at("device"), "");
            EXPECT_EQ(s.at("seed"), 1);
            EXPECT_TRUE(s.contains("version"));
            const auto& set = s.at("settings");
            EXPECT_EQ(set.at("size"), nlohmann::json({32, 24}));
            EXPECT_EQ(set.at("photons"), 300);
            EXPECT_EQ(set.at("map"), map);
            EXPECT_EQ(set.at("max_radius"), 0.2);
            const auto& p = s.at("photons");
            const auto count = [&](const char* key) { return p.at(key).get<std::uint64_t>(); };
            EXPECT_EQ(count("emitted"), count("absorbed") + count("escaped") + count("cut_off") + count("invalid"));
            EXPECT_EQ(count("stored"), 300u);
            EXPECT_GT(count("direct"), 0u);
            EXPECT_TRUE(p.contains("dropped"));
            EXPECT_EQ(s.at("map").at("builder"), map);
            EXPECT_EQ(s.at("map").at("cells"), 32 * 32);
            EXPECT_TRUE(s.at("map").contains("overfull_cells"));
            EXPECT_TRUE(s.at("map").contains("redistributed_flux"));
            for (const auto* stage : {"trace_photons", "build_map", "trace_rays", "radiance_estimate"}) {
                EXPECT_GT(s.at("stages").at(stage).at("ms"), 0) << stage;
                EXPECT_GT(s.at("stages").at(stage).at("passes"), 0) << stage;
                EXPECT_GT(s.at("stages").at(stage).at("device_bytes"), 0) << stage;
            }
            EXPECT_GT(s.at("estimate").at("mean_count"), 0);
            EXPECT_GT(s.at("estimate").at("mean_radius"), 0);
            EXPECT_GE(s.at("estimate").at("mean_visited"), s.at("estimate").at("mean_count"));
            EXPECT_FALSE(s.at("kernels").empty());
            for (const auto& [name, k] : s.at("kernels").items())
                EXPECT_TRUE(
                    k.contains("instructions") && k.contains("compile_ms") && k.contains("ms") && k.contains("passes"))
                    << name;
            EXPECT_GT(s.at("peak_memory_bytes"), 1 << 20);
            EXPECT_GT(s.at("peak_device_bytes"), 0);
            EXPECT_GT(s.at("total_ms"), 0);
        }
    }

    TEST_F(program, refuses_wrong_leak_policies)
    {
        const std::string list
            = "expected none, or some of side, normals, normals=COS, disc, disc=C with commas between them";
        for (const auto& [given, expected] : std::vector<std::pair<std::string, std::string>>{
                 {"walls", "\"walls\" given; " + list}, {"side,", "\"\" given; " + list}, {"", list},
                 {",side", "\"\" given; " + list}, {"side=1", "\"side=1\" given; " + list},
                 {"side, disc", "\" disc\" given; " + list}, {"none,side", "expected none alone"},
                 {"side,none", "expected none alone"}, {"none=0", list}, {"side,side", "has side twice"},
                 {"disc,disc=4", "has disc twice"}, {"normals=", "expected normals=COS, a cosine from -1 to 1"},
                 {"normals=1.1", "\"1.1\" given; expected normals=COS"}, {"normals=nan", "expected normals=COS"},
                 {"normals=half", "expected normals=COS"},
                 {"disc=0.9", "\"0.9\" given; expected disc=C, a compression from 1 to 1e6"},
                 {"disc=1e300", "expected disc=C"}, {"disc=4=4", "expected disc=C"}}) {
            const auto e = run(small_with({"--leaks", given}));
            EXPECT_EQ(e.code, 2) << given;
            EXPECT_NE(e.err.find("--leaks"), std::string::npos) << given << ": " << e.err;
            EXPECT_NE(e.err.find(expected), std::string::npos) << given << ": " << e.err;
        }
        EXPECT_EQ(files(), 0u);
    }

    TEST_F(program, obeys_what_is_said_of_the_estimate)
    {
        struct row {
            std::vector<std::string> options;
            nlohmann::json settings; ///< some of those in the statistics
        };
        using json = nlohmann::json;
        const json by_default = json::parse(
            R"({"search": "exact_k", "kernel": "silverman", "bias": "unbiased", "leaks": {"side": true}, "edge_correction": "none", "only": "all"})");
        const json paper = json::parse(
            R"({"search": "at_least_k", "kernel": "constant", "bias": "paper", "leaks": {}, "edge_correction": "none", "only": "all"})");
        const auto but = [](json all, const char* more) {
            all.update(json::parse(more));
            return all;
        };
        const std::vector<row> rows{
            {{}, by_default},
            {{"--search", "at_least_k"}, but(by_default, R"({"search": "at_least_k"})")},
            {{"--search", "fixed_radius", "--kernel", "cone"},
                but(by_default, R"({"search": "fixed_radius", "kernel": "cone"})")},
            {{"--kernel", "epanechnikov"}, but(by_default, R"({"kernel": "epanechnikov"})")},
            {{"--kernel", "silverman", "--bias", "paper"},
                but(by_default, R"({"kernel": "silverman", "bias": "paper"})")},
            {{"--leaks", "none"}, but(by_default, R"({"leaks": {}})")},
            {{"--leaks", "side"}, by_default},
            {{"--leaks", "normals"}, but(by_default, R"({"leaks": {"normals": 0.5}})")},
            {{"--leaks", "disc"}, but(by_default, R"({"leaks": {"disc": 4}})")},
            {{"--leaks", "disc=2.5,side,normals=-0.3"},
                but(by_default, R"({"leaks": {"side": true, "normals": -0.3, "disc": 2.5}})")},
            {{"--leaks", "normals=-1,disc=1"}, but(by_default, R"({"leaks": {}})")},
            {{"--edge-correction", "none"}, by_default},
            {{"--leaks", "normals", "--edge-correction", "polygons"},
                but(by_default, R"({"leaks": {"normals": 0.5}, "edge_correction": "polygons"})")},
            {{"--as-paper", "--edge-correction", "polygons", "--leaks", "side,normals=0.2"},
                but(paper, R"({"leaks": {"side": true, "normals": 0.2}, "edge_correction": "polygons"})")},
            {{"--only", "direct"}, but(by_default, R"({"only": "direct"})")},
            {{"--only", "caustic"}, but(by_default, R"({"only": "caustic"})")},
            {{"--only", "indirect"}, but(by_default, R"({"only": "indirect"})")},
            {{"--as-paper"}, paper},
            {{"--kernel", "cone", "--as-paper", "--leaks", "side"},
                but(paper, R"({"kernel": "cone", "leaks": {"side": true}})")},
            {{"--as-paper", "--search", "exact_k", "--bias", "unbiased", "--only", "caustic"},
                but(paper, R"({"search": "exact_k", "bias": "unbiased", "only": "caustic"})")},
        };
        const auto expect = [&](const std::vector<std::string>& arguments, const json& expected) {
            const auto e = run(arguments);
            ASSERT_EQ(e.code, 0) << e.err;
            const auto set = json::parse(contents(folder / "stats.json")).at("settings");
            for (const auto& [key, value] : expected.items())
                EXPECT_EQ(set.at(key), value) << key << " of " << json(arguments);
        };
        for (const auto& [options, settings] : rows) {
            auto arguments = small_with({"--stats", "stats.json"});
            arguments.insert(arguments.end(), options.begin(), options.end());
            expect(arguments, settings);
        }
        // A scene that has wishes of its own; lengths are in m, so its statistics' settings are a scene's again.
        auto wishes = json::parse(contents(ring), nullptr, true, true);
        wishes["render"].update(json::parse(
            R"({"search": "fixed_radius", "kernel": "silverman", "bias": "paper", "leaks": {"normals": 0.25, "disc": 3}, "edge_correction": "polygons"})"));
        std::ofstream(folder / "wishes.json") << wishes;
        auto arguments = small_with({"--stats", "stats.json", "-o", "a.exr"});
        arguments[1] = "wishes.json";
        const auto wished = but(by_default,
            R"({"search": "fixed_radius", "kernel": "silverman", "bias": "paper", "leaks": {"normals": 0.25, "disc": 3}, "edge_correction": "polygons"})");
        expect(arguments, wished);
        EXPECT_NE(
            contents(folder / "a.exr")
                .find(
                    R"("search":"fixed_radius","kernel":"silverman","bias":"paper","leaks":{"normals":0.25,"disc":3.0},"edge_correction":"polygons","only":"all")"),
            std::string::npos)
            << "the EXR's note";
        // A policy taken away that the scene's correction needs is refused, with the way out; nothing is drawn.
        auto torn = arguments;
        torn.back() = "torn.exr";
        torn.insert(torn.end(), {"--leaks", "side"});
        const auto refused = run(torn);
        EXPECT_EQ(refused.code, 2);
        EXPECT_NE(refused.err.find("on the command line: edge_correction: photons of adjoining walls would count"),
            std::string::npos)
            << refused.err;
        EXPECT_NE(refused.err.find("needs the leak policy normals with a cosine above 0"), std::string::npos)
            << refused.err;
        EXPECT_FALSE(fs::exists(folder / "torn.exr"));
        arguments.insert(arguments.end(), {"--kernel", "cone", "--leaks", "side", "--edge-correction", "none"});
        expect(arguments, but(wished, R"({"kernel": "cone", "leaks": {"side": true}, "edge_correction": "none"})"));
        arguments.emplace_back("--as-paper");
        expect(arguments, but(paper, R"({"kernel": "cone", "leaks": {"side": true}})"));
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

    TEST_F(program, parts_of_the_light_add_up)
    {
        // With a given radius and a constant kernel an estimate is linear in the photons.
        const std::string box = PHOTONGRID_SCENES "/cornell_box.json";
        const auto draw = [&](std::vector<std::string> more) {
            std::vector<std::string> arguments{"render", box, "--backend", "serial", "--size", "32x32", "--photons",
                "4000", "--search", "fixed_radius", "--max-radius", "0.2", "--kernel", "constant", "--stats", "s.json",
                "-o", "a.exr"};
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

    TEST_F(program, writes_the_running_estimate)
    {
        ASSERT_EQ(run(small_with({"--progressive", "steps", "-o", "last.png", "--k", "200"})).code, 2) << "--k twice";
        const auto e = run(small_with({"--progressive", "steps", "-o", "last.png"}));
        ASSERT_EQ(e.code, 0) << e.err;
        ASSERT_TRUE(fs::exists(folder / "steps/ring-0001.png"));
        std::string newest;
        std::size_t pictures = 0;
        for (const auto& f : fs::directory_iterator(folder / "steps"))
            if (f.path().extension() == ".png") {
                newest = std::max(newest, f.path().string());
                ++pictures;
            }
        EXPECT_EQ(contents(newest), contents(folder / "last.png")) << "the last one is the picture";

        // The table: a line a picture, times ascending, the error of the last one 0 and the first one's larger.
        std::istringstream table(contents(folder / "steps/ring.csv"));
        std::string line;
        std::getline(table, line);
        EXPECT_EQ(line, "picture,ms,relmse");
        std::vector<double> times, errors;
        while (std::getline(table, line)) {
            char name[64];
            double ms = 0, relmse = 0;
            ASSERT_EQ(std::sscanf(line.c_str(), "%63[^,],%lf,%lf", name, &ms, &relmse), 3) << line;
            EXPECT_TRUE(fs::exists(folder / "steps" / name)) << line;
            times.push_back(ms);
            errors.push_back(relmse);
        }
        ASSERT_EQ(times.size(), pictures);
        EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
        EXPECT_GT(errors.front(), 0);
        EXPECT_EQ(errors.back(), 0);
    }

    TEST_F(program, never_replaces_a_backend_asked_for)
    {
        const auto e = run({"render", ring, "--backend", "vulkan", "--device", "no such device", "-o", "a.png"});
        EXPECT_EQ(e.code, 4);
        EXPECT_NE(e.err.find("vulkan"), std::string::npos) << e.err;
        EXPECT_EQ(files(), 0u);
    }

    TEST_F(program, auto_says_what_it_chose)
    {
        auto arguments = small;
        arguments[3] = "auto";
        const auto e = run(arguments);
        EXPECT_EQ(e.code, 0) << e.err;
        EXPECT_NE(e.err.find("--backend auto: "), std::string::npos) << e.err;
    }

    // A file-size limit stands for a full disk. Of two pictures the first fits.
    TEST_F(program, a_full_disk_leaves_whole_files_or_none)
    {
        rlimit old{};
        ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
        const rlimit small_files{.rlim_cur = 4096, .rlim_max = old.rlim_max};
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small_files), 0);
        const auto child = start(small_with({"-o", "a.png", "-o", "b.pfm", "--stats", "a.json"}));
        setrlimit(RLIMIT_FSIZE, &old);
        const auto e = wait(child);
        EXPECT_EQ(e.code, 5) << e.err;
        EXPECT_NE(e.err.find("b.pfm: cannot be written: File too large"), std::string::npos) << e.err;
        EXPECT_EQ(e.out, "a.png\n");
        EXPECT_TRUE(fs::exists(folder / "a.png"));
        EXPECT_EQ(files(), 1u);
    }

    // A picture that would take minutes, and a signal soon after it began.
    TEST_F(program, an_interrupt_keeps_the_best_picture)
    {
        for (const int signal : {SIGINT, SIGTERM}) {
            const auto begun = std::chrono::steady_clock::now();
            const auto child = start({"render", ring, "--backend", "serial", "--size", "64x64", "--spp", "60000",
                "--photons", "300", "-o", "a.pfm", "--stats", "a.json"});
            std::this_thread::sleep_for(std::chrono::milliseconds(700));
            ::kill(child, signal);
            const auto e = wait(child);
            EXPECT_EQ(e.code, 130) << e.err;
            EXPECT_NE(e.err.find("interrupted at 0 %"), std::string::npos) << e.err;
            EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(30));
            ASSERT_EQ(files(), 1u) << "statistics of an unfinished picture, or a part of a file";
            const auto kept = read_image((folder / "a.pfm").string());
            ASSERT_EQ(
                run({"render", ring, "--backend", "serial", "--size", "64x64", "--photons", "300", "-o", "b.pfm"}).code,
                0);
            const auto whole = read_image((folder / "b.pfm").string());
            double sum = 0, expected = 0;
            for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
                sum += static_cast<double>(kept.pixels[i].x);
                expected += static_cast<double>(whole.pixels[i].x);
            }
            EXPECT_NEAR(sum, expected, 0.05 * expected) << "too few rays make it noisier, not darker";
            fs::remove(folder / "a.pfm");
            fs::remove(folder / "b.pfm");
        }
    }

    TEST_F(program, goes_on_where_it_was_interrupted)
    {
        const std::vector<std::string> command{
            "render", ring, "--backend", "serial", "--size", "64x64", "--spp", "40", "--photons", "300", "--aov"};
        const auto with = [&](std::vector<std::string> more) {
            auto all = command;
            all.insert(all.end(), more.begin(), more.end());
            return all;
        };
        ASSERT_EQ(run(with({"-o", "whole.exr"})).code, 0);
        int interruptions = 0;
        for (int lives = 0; lives < 100 && !fs::exists(folder / "done"); ++lives) {
            const auto child = start(with({"--resume", "unfinished", "-o", "a.exr"}));
            std::this_thread::sleep_for(std::chrono::milliseconds(100 + 100 * lives));
            ::kill(child, SIGINT);
            const auto e = wait(child);
            if (e.code == 0)
                break;
            ASSERT_EQ(e.code, 130) << e.err;
            if (fs::exists(folder / "unfinished")) {
                ++interruptions;
                EXPECT_NE(e.err.find("goes on from unfinished"), std::string::npos) << e.err;
            }
            if (interruptions == 1 && fs::exists(folder / "unfinished")) {
                // It is no other picture's.
                const auto other = run(with({"--resume", "unfinished", "--seed", "5", "-o", "a.exr"}));
                EXPECT_EQ(other.code, 5) << other.err;
                EXPECT_NE(other.err.find("a different set of settings"), std::string::npos) << other.err;
                auto bytes = contents(folder / "unfinished");
                bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
                std::ofstream(folder / "damaged", std::ios::binary) << bytes;
                for (const auto* broken : {"damaged", "whole.exr"}) {
                    const auto refused = run(with({"--resume", broken, "-o", "a.exr"}));
                    EXPECT_EQ(refused.code, 5) << refused.err;
                    EXPECT_NE(refused.err.find(std::string(broken) + ": "), std::string::npos) << refused.err;
                }
            }
        }
        EXPECT_GE(interruptions, 1) << "no picture was ever interrupted";
        EXPECT_FALSE(fs::exists(folder / "unfinished")) << "the file has served";
        EXPECT_EQ(contents(folder / "a.exr"), contents(folder / "whole.exr"));
    }

    TEST_F(program, shows_stages_in_a_strip)
    {
        ASSERT_EQ(run(small_with({"-o", "reference.pfm"})).code, 0);
        const auto e = run(small_with({"--progressive", "steps", "--every", "1", "--strip", "strip.pfm", "--crop",
            "10x8+4+2", "--reference", "reference.pfm", "-o", "last.pfm"}));
        ASSERT_EQ(e.code, 0) << e.err;
        EXPECT_EQ(e.out, "last.pfm\nstrip.pfm\n");
        const auto strip = read_image((folder / "strip.pfm").string()),
                   last = read_image((folder / "last.pfm").string());
        ASSERT_EQ(strip.height, 8u);
        ASSERT_EQ((strip.width + 2) % 12, 0u);
        EXPECT_GE(strip.width, 22u);
        for (std::uint32_t y = 0; y < 8; ++y)
            for (std::uint32_t x = 0; x < 10; ++x)
                EXPECT_EQ(
                    strip.pixels[y * strip.width + strip.width - 10 + x], last.pixels[(y + 2) * last.width + 4 + x])
                    << "the last stage is the picture";
        // The last picture is the reference.
        const auto table = contents(folder / "steps/ring.csv");
        EXPECT_EQ(table.substr(0, table.find('\n')), "picture,ms,relmse,relmse_to_reference");
        EXPECT_EQ(table.substr(table.size() - 5), ",0,0\n");

        EXPECT_EQ(run(small_with({"--strip", "strip.pfm", "--crop", "10x8+60+2"})).code, 2);
        EXPECT_EQ(run(small_with({"--progressive", "steps", "--reference", "strip.pfm"})).code, 2);
    }

} // namespace
} // namespace photongrid
