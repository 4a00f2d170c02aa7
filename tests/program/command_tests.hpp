// The program's commands: results and errors.
#pragma once

#include "../core/under_test.hpp"
#include "program_under_test.hpp"

namespace photongrid {
namespace {

    TEST_F(program, helps)
    {
        const auto help = run({"--help"});
        EXPECT_EQ(help.code, 0);
        for (const auto* word : {"render", "view", "compare", "error", "check", "devices", "Exit codes", "130"})
            EXPECT_NE(help.out.find(word), std::string::npos) << word;
        const auto render = run({"render", "--help"});
        EXPECT_EQ(render.code, 0);
        for (const auto* option :
            {"--backend", "--device", "--map", "--slots", "--surplus", "--photons", "--k", "--grid", "--max-radius",
                "--size", "--spp", "--light-samples", "--depth", "--seed", "--exposure", "-o", "--search", "--filter",
                "--bias", "--leaks", "--edge-correction", "--only", "--until-error", "--percentile", "--seconds",
                "--aov", "--as-paper", "--exact", "--stats", "--shader-cache", "--time-passes", "--progressive",
                "--every", "--strip", "--crop", "--reference", "--resume", "--quiet"})
            EXPECT_NE(render.out.find(option), std::string::npos) << option;
        for (const auto* group : {"Scene:", "Picture (default: the scene's):", "Light (", "Photons (", "Estimate (",
                 "Backend:", "Output:", "The paper's method and fine tuning ("})
            EXPECT_NE(render.out.find("\n" + std::string(group)), std::string::npos) << group;
        EXPECT_EQ(render.out.find("; default: the scene's\n"), std::string::npos) << "the groups say it";
        EXPECT_EQ(render.out.find("photongrid check my_scene.json"), std::string::npos) << "another command's example";
        EXPECT_NE(run({"check", "--help"}).out.find("photongrid check my_scene.json"), std::string::npos);
        for (const auto* command : {"render", "view", "reference"}) {
            const auto words = run({command, "--help"}).out;
            EXPECT_EQ(words.find(":{"), std::string::npos) << command << " shows choices twice:\n" << words;
        }
        const auto version = run({"--version"});
        EXPECT_EQ(version.code, 0);
        EXPECT_EQ(version.out.substr(0, 11), "photongrid ");
    }

    TEST_F(program, rejects_wrong_command_lines)
    {
        EXPECT_EQ(run({}).code, 2);
        const auto unknown = run({"rendr", "ring.json"});
        EXPECT_EQ(unknown.code, 2);
        EXPECT_EQ(unknown.err,
            "photongrid: \"rendr\" is not a command; expected render, view, reference, compare, error, check, convert "
            "or devices\n"
            "Run with --help for more information.\n");
        const auto bare = run({ring});
        EXPECT_EQ(bare.code, 2);
        EXPECT_NE(bare.err.find("is a file, not a command; \"photongrid render "), std::string::npos) << bare.err;
        EXPECT_EQ(run({"render"}).code, 2);
        for (const auto& wrong : std::vector<std::vector<std::string>>{{"--backend", "cuda"}, {"--size", "32"},
                 {"--size", "32x-4"}, {"--size", "0x4"}, {"--grid", "1,2"}, {"--grid", "1,2,3,4"}, {"--grid", "0,1,1"},
                 {"--photons", "15e-1"}, {"--photons", "1e10"}, {"--photons", "-1"}, {"--photons", "1e"},
                 {"--photons", "nan"}, {"--photons", "99999999999"}, {"--k", "0"}, {"--max-radius", "nan"},
                 {"--max-radius", "-1"}, {"--spp", "4294967295"}, {"--passes", "automatic"}, {"--exposure", "inf"},
                 {"--slots", "17"}, {"--surplus", "all"}, {"--map", "hash"}, {"--device", "0"}, {"--time-passes"},
                 {"--spp", "0"}, {"--nonsense"}, {"--search", "exact"}, {"--filter", "gauss"}, {"--bias", "none"},
                 {"--edge-correction", "disks"}, {"--edge-correction"}, {"--only", "caustics"},
                 {"--as-paper", "--as-paper=maybe"}}) {
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

    // What is lost on a full device, or is quoted, is said.
    TEST_F(program, says_when_the_standard_output_is_full)
    {
        for (const std::string command : {"devices", "check " PHOTONGRID_SCENES "/ring.json"}) {
            const auto whole = PHOTONGRID_PROGRAM " " + command + " > /dev/full 2> " + (folder / "err").string();
            const int status = std::system(whole.c_str());
            ASSERT_TRUE(WIFEXITED(status));
            EXPECT_EQ(WEXITSTATUS(status), 5) << command;
            EXPECT_NE(contents(folder / "err").find("the standard output cannot be written: No space left"),
                std::string::npos)
                << contents(folder / "err");
        }
    }
    TEST_F(program, quotes_what_was_given)
    {
        for (const std::string size : {"8x", "8", "x8", "8x8x8", "8xa"})
            EXPECT_NE(
                run({"render", ring, "--size", size}).err.find('"' + size + "\" given; expected width and height"),
                std::string::npos)
                << size;
    }

    /// What is chosen is printed as options, which draw the same picture.
    TEST_F(program, draws_scenes_without_settings_on_every_device)
    {
        auto scene = nlohmann::json::parse(std::ifstream(ring));
        scene.erase("render");
        scene.erase("as_paper");
        std::ofstream(folder / "s.json") << scene;
        for (const std::string backend : {"serial", "cpu", "gl", "vulkan"}) {
            std::vector<std::string> command{
                "render", "s.json", "--backend", backend, "--size", "32x24", "--passes", "2", "-o", backend + ".pfm"};
            const auto e = run(command);
            ASSERT_EQ(e.code, 0) << e.err;
            const std::string mark = "photongrid: chosen: ";
            const auto at = e.err.find(mark);
            ASSERT_NE(at, std::string::npos) << e.err;
            std::istringstream options(e.err.substr(at + mark.size(), e.err.find('\n', at) - at - mark.size()));
            command.back() = "again.pfm";
            for (std::string word; options >> word;)
                command.push_back(word);
            ASSERT_EQ(run(command).code, 0) << backend;
            EXPECT_EQ(contents(folder / (backend + ".pfm")), contents(folder / "again.pfm")) << e.err;
            const auto same = run({"compare", backend + ".pfm", "serial.pfm", "--max-relmse", "0.05"});
            EXPECT_EQ(same.code, 0) << backend << ": " << same.out << e.err;
        }
    }

    /// Variants of the ring's scene that would give a black or a white picture without a word: they are drawn, and
    /// stderr says what is odd.
    class program_on_odd_scenes : public program {
    protected:
        /// What the program says of `scene`, which it draws to a.png.
        std::string draw(const nlohmann::json& scene, const std::vector<std::string>& more = {}) const
        {
            std::ofstream(folder / "s.json") << scene;
            std::vector<std::string> all{"render", "s.json", "--backend", "serial", "--size", "32x24", "--photons",
                "300", "--k", "16", "--grid", "32,1,32", "-o", "a.png"};
            all.insert(all.end(), more.begin(), more.end());
            const auto e = run(all);
            EXPECT_EQ(e.code, 0) << e.err;
            return e.err;
        }
        static void expect(const std::string& said, std::initializer_list<const char*> words)
        {
            for (const auto* word : words)
                EXPECT_NE(said.find(word), std::string::npos) << said;
        }
        nlohmann::json with_power(double factor) const
        {
            auto scene = whole;
            auto& power = scene["lights"][0]["power"];
            if (power.is_number())
                power = power.get<double>() * factor;
            else
                for (auto& channel : power)
                    channel = channel.get<double>() * factor;
            return scene;
        }

        const nlohmann::json whole = nlohmann::json::parse(contents(ring));
    };

    TEST_F(program_on_odd_scenes, says_which_exposure_would_fit)
    {
        EXPECT_EQ(draw(whole), "");
        expect(run({"check", "s.json"}).out, {"1 light of ", " W (red + green + blue), ", " m\n"});
        const auto dark = draw(with_power(1e-4));
        expect(dark, {"the PNG is almost black at exposure 0 EV", "--exposure ", " would fit"});
        std::istringstream after(dark.substr(dark.find("--exposure ") + 11));
        double fitting = 0;
        after >> fitting;
        EXPECT_EQ(draw(with_power(1e-4), {"--exposure", std::to_string(fitting)}), "");
        expect(draw(with_power(1e5)), {"the PNG is almost white"});
    }

    TEST_F(program_on_odd_scenes, fits_the_exposure_where_nothing_sets_it)
    {
        // A scene looks the same however bright its lights are.
        std::string looks;
        for (const double factor : {1.0, 0x1p-13, 0x1p17}) {
            auto scene = with_power(factor);
            scene["render"].erase("exposure");
            const auto said = draw(scene);
            expect(said, {"exposure: ", " EV, fitted to the picture; --exposure sets it"});
            EXPECT_EQ(said.find("warning"), std::string::npos) << said;
            if (looks.empty())
                looks = contents(folder / "a.png");
            EXPECT_EQ(contents(folder / "a.png"), looks) << factor;
            EXPECT_EQ(draw(scene, {"--exposure", "auto", "--quiet"}), "");
            EXPECT_EQ(contents(folder / "a.png"), looks) << factor;
        }
    }

    TEST_F(program_on_odd_scenes, says_what_of_a_mesh_has_no_area_or_normal)
    {
        auto odd = whole;
        std::ofstream(folder / "odd.ply")
            << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
               "z\nproperty "
               "float nx\nproperty float ny\nproperty float nz\nelement face 2\nproperty list uchar int "
               "vertex_indices\nend_header\n0 0 0 0 1 0\n0.1 0 0 0 0 0\n0 0.1 0 1 0 0\n3 0 1 2\n3 0 1 1\n";
        const auto material = odd["shapes"][0]["material"];
        odd["shapes"].push_back({{"type", "mesh"}, {"file", "odd.ply"}, {"material", material}});
        expect(draw(odd), {});
        expect(run({"check", "s.json"}).out,
            {"meshes of 2 triangles", "1 triangle of meshes without area", "1 normal of meshes of length 0"});
    }

    TEST_F(program_on_odd_scenes, says_what_the_camera_misses)
    {
        auto away = whole; // straight up
        away["camera"]["look_at"] = away["camera"]["position"];
        away["camera"]["look_at"][1] = 1 + away["camera"]["look_at"][1].get<double>();
        away["camera"]["up"] = {0, 0, 1};
        expect(draw(away), {"every pixel is black", "sees nothing that is lit"});
        expect(run({"check", "s.json"}).out, {"looks away from the whole scene"});
    }

    /// A floor under a sun, the first scene that people try.
    TEST_F(program_on_odd_scenes, draws_a_lone_mesh_and_says_how_much_indirect_light_there_is_at_most)
    {
        const auto floor = nlohmann::json::parse(R"({"photongrid": 1, "units": {"length": "m", "power": "W"},
            "camera": {"position": [0, 2, 0], "look_at": [0, 0, 0], "up": [0, 0, -1], "vertical_fov": 39.6},
            "materials": {"white": {"type": "lambertian", "reflectance": 0.5}},
            "shapes": [{"type": "mesh", "positions": [[-2, 0, -2], [2, 0, -2], [2, 0.5, 2], [-2, 0.5, 2]],
                "triangles": [[0, 2, 1], [0, 3, 2]], "material": "white"}],
            "lights": [{"name": "sun", "type": "directional", "direction": [0, -1, 0], "irradiance": 3}],
            "render": {"size": [32, 24], "photons": 300, "k": 16, "max_radius": 0.3}})");
        for (const auto* emission : {"power", "guided"}) {
            const auto said = draw(floor, {"--emission", emission, "--exposure", "0", "-o", "floor.exr"});
            expect(said, {" photon paths from 'sun'", "direct", " is at most ", " %"});
            // Reflectance over pi times the irradiance of a plane that leans by atan(0.5 / 4).
            const auto picture = read_image((folder / "floor.exr").string());
            EXPECT_NEAR(picture.pixels[12 * 32 + 16].x, 0.5 / M_PI * 3 * std::cos(std::atan(0.125)), 0.01);
        }
    }

    TEST_F(program_on_odd_scenes, says_where_edge_correction_changes_nothing)
    {
        const std::vector<std::string> corrected{"--edge-correction", "polygons", "--leaks", "side,min_cosine=0.5"};
        EXPECT_EQ(draw(whole, corrected), ""); // its table is a polygon
        auto shapes = whole;
        for (auto& shape : shapes["shapes"])
            if (shape["type"] == "polygon") {
                const auto material = shape["material"];
                shape = {{"type", "mesh"}, {"positions", shape["vertices"]}, {"triangles", {{0, 1, 2}, {0, 2, 3}}},
                    {"material", material}};
            }
        expect(draw(shapes, corrected), {"--edge-correction polygons changes nothing here"});
        EXPECT_EQ(draw(shapes), "");
    }

    TEST_F(program_on_odd_scenes, names_materials_that_no_shape_has)
    {
        auto unused = whole;
        unused["materials"]["spare"] = {{"type", "mirror"}};
        draw(unused);
        expect(run({"check", "s.json"}).out, {"no shape has the material \"spare\""});
    }

    TEST_F(program, lists_devices)
    {
        const auto e = run({"devices"});
        EXPECT_EQ(e.code, 0);
        for (const auto* name : {"serial  ", "gl  ", "gl-osmesa  ", "vulkan  "})
            EXPECT_NE(("\n" + e.out).find(std::string("\n") + name), std::string::npos) << e.out;
    }

    /// Other tests of the program take whatever driver comes, so this one fails where hardware was asked for
    /// (tests/run.sh --device hardware) and only software devices are there.
    TEST_F(program, lists_a_hardware_device_if_asked_for)
    {
        if (!testing::hardware_wanted())
            return;
        const auto e = run({"devices"});
        EXPECT_EQ(e.code, 0) << e.err;
        EXPECT_NE(e.out.find("    hardware, buffers of up to "), std::string::npos) << e.out;
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

    TEST_F(program, reads_scenes_of_pbrt_and_says_what_it_replaced)
    {
        std::ofstream(folder / "s.pbrt") << "Camera \"perspective\"\nWorldBegin\nShape \"disk\"\nMaterial \"hair\"\n"
                                            "Translate 0 0 4\nShape \"sphere\"\n";
        const std::string note = "s.pbrt:4:1: note: material \"hair\": drawn as diffuse 0.5\n",
                          sky = "s.pbrt: note: the file has no light; a sky with a soft bright patch is added\n";
        const auto checked = run({"check", "s.pbrt"});
        EXPECT_EQ(checked.code, 0) << checked.err;
        EXPECT_NE(checked.out.find("\"s\": 2 shapes, 2 materials, 1 light"), std::string::npos) << checked.out;
        EXPECT_NE(checked.out.find(note + sky), std::string::npos) << checked.out;
        const auto strict = run({"check", "s.pbrt", "--strict"});
        EXPECT_EQ(strict.code, 3);
        EXPECT_TRUE(strict.err.starts_with("s.pbrt:4:1: error: material \"hair\": drawn as diffuse 0.5")) << strict.err;
        EXPECT_EQ(run({"check", "s.pbrt", "--unit", "0"}).code, 2);
        EXPECT_EQ(run({"check", ring, "--unit", "2"}).code, 3); // it has its own

        const auto drawn = run({"render", "s.pbrt", "--backend", "serial", "--size", "16x12", "--photons", "50",
            "--passes", "1", "-o", "s.pfm", "--stats", "stats.json"});
        ASSERT_EQ(drawn.code, 0) << drawn.err;
        EXPECT_NE(drawn.err.find(note), std::string::npos) << drawn.err;
        const auto notes = nlohmann::json::parse(contents(folder / "stats.json")).at("notes");
        ASSERT_EQ(notes.size(), 2u);
        EXPECT_EQ(notes.at(0).get<std::string>() + "\n", note);
    }

    TEST_F(program, converts_scenes)
    {
        const std::string still_life = PHOTONGRID_SCENES "/still_life.pbrt";
        const auto made = run({"convert", still_life, "still.json"});
        EXPECT_EQ(made.code, 0) << made.err;
        EXPECT_EQ(made.out, "still.json\nstill: 1 file\n");
        EXPECT_NE(made.err.find("note: dispersion of \"glass-BK7\" is left out"), std::string::npos) << made.err;
        EXPECT_EQ(run({"check", "still.json"}).code, 0);
        const auto drawn = [&](const std::string& scene, const std::string& picture) {
            const auto e = run({"render", scene, "--backend", "serial", "--size", "16x12", "--photons", "50", "--spp",
                "1", "--quiet", "-o", picture});
            EXPECT_EQ(e.code, 0) << e.err;
            return contents(folder / picture);
        };
        EXPECT_EQ(drawn(still_life, "a.pfm"), drawn("still.json", "b.pfm"));

        ASSERT_EQ(run({"convert", "still.json", "again.pbrt"}).code, 0);
        ASSERT_EQ(run({"convert", "still.json", "again.glb"}).code, 0);
        EXPECT_TRUE(contents(folder / "again.glb").starts_with("glTF"));
        EXPECT_EQ(run({"check", "again.pbrt", "--strict"}).code, 0);
        const auto strict = run({"convert", "still.json", "strict.glb", "--strict"});
        EXPECT_EQ(strict.code, 3);
        EXPECT_TRUE(strict.err.starts_with("strict.glb: error: material \"table\": its texture is rounded to 8 bits"))
            << strict.err;
        EXPECT_FALSE(fs::exists(folder / "strict.glb"));
    }

    TEST_F(program, refuses_to_convert_to_what_it_cannot_write)
    {
        fs::copy(ring, folder / "ring.json");
        const auto before = contents(folder / "ring.json");
        const auto same = run({"convert", "ring.json", "./ring.json"});
        EXPECT_EQ(same.code, 2);
        EXPECT_NE(same.err.find("OUT: \"./ring.json\" is the scene; expected another file"), std::string::npos)
            << same.err;
        const auto unknown = run({"convert", "ring.json", "ring.xyz"});
        EXPECT_EQ(unknown.code, 5);
        EXPECT_NE(
            unknown.err.find("ring.xyz: has no known extension; expected .json (photongrid), .pbrt, .gltf or .glb"),
            std::string::npos)
            << unknown.err;
        const auto no_folder = run({"convert", "ring.json", "none/ring.json"});
        EXPECT_EQ(no_folder.code, 5);
        EXPECT_NE(no_folder.err.find("none/ring.json: there is no folder none"), std::string::npos) << no_folder.err;
        EXPECT_EQ(contents(folder / "ring.json"), before);
        EXPECT_EQ(files(), 1u);
    }

    // Each block of 2 x 2 pixels has the same mean, though no pixel is the same.
    TEST_F(program, compares_means_of_blocks)
    {
        image even{.width = 5, .height = 4, .pixels = std::vector<glm::vec3>(20, glm::vec3(2))}, uneven = even;
        for (std::size_t i = 0; i < uneven.pixels.size(); ++i)
            uneven.pixels[i] = glm::vec3(i % 5 % 2 == 0 ? 1.0f : 3.0f);
        write_image((folder / "even.pfm").string(), even);
        write_image((folder / "uneven.pfm").string(), uneven);
        EXPECT_EQ(run({"compare", "uneven.pfm", "even.pfm", "--max-relmse", "0.1"}).code, 1);
        const auto means = run({"compare", "uneven.pfm", "even.pfm", "--average", "2", "--max-relmse", "0"});
        EXPECT_EQ(means.code, 0) << means.out << means.err;
        EXPECT_EQ(run({"compare", "uneven.pfm", "even.pfm", "--average", "5"}).code, 5);
        const auto again
            = run({"compare", "uneven.pfm", "even.pfm", "--again", "even.pfm"}).out; // (+-1)^2 / 2.01^2 / 2
        EXPECT_NE(again.find("\nseeds   0.123759 of relMSE is noise of uneven.pfm\n"), std::string::npos) << again;
        EXPECT_EQ(run({"compare", "uneven.pfm", "even.pfm", "--again", "none.pfm"}).code, 5);
        const auto noise = run({"compare", "uneven.pfm", "even.pfm", "--noise"}).out;
        EXPECT_NE(noise.find("\nnoise   "), std::string::npos) << noise;
        EXPECT_NE(noise.find(" and 0, of each by itself\n"), std::string::npos) << noise;
    }

    TEST_F(program, renders_several_passes)
    {
        const auto stats_of = [&](const char* picture, const char* passes) {
            const auto e = run(small_with({"-o", picture, "--passes", passes, "--stats", "stats.json"}));
            EXPECT_EQ(e.code, 0) << e.err;
            return nlohmann::json::parse(contents(folder / "stats.json"));
        };
        const auto one = stats_of("one.pfm", "1"), two = stats_of("two.pfm", "2");
        EXPECT_EQ(one.at("settings").at("passes"), 1);
        EXPECT_EQ(two.at("settings").at("passes"), 2);
        EXPECT_EQ(one.at("photons").at("stored"), 300);
        EXPECT_EQ(two.at("photons").at("stored"), 600) << "each pass has photons of its own";
        EXPECT_NE(contents(folder / "one.pfm"), contents(folder / "two.pfm"));
        EXPECT_EQ(run({"compare", "one.pfm", "two.pfm", "--max-relmse", "1e-3"}).code, 1);
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

    TEST_F(program, a_grid_makes_the_automatic_map_of_a_scene_a_sorted_one)
    {
        auto scene = nlohmann::json::parse(contents(ring));
        scene["render"].erase("grid");
        scene["render"].erase("map");
        std::ofstream(folder / "no_grid.json") << scene;
        const auto drawn = [&](std::vector<std::string> more) {
            more.insert(more.begin(),
                {"render", "no_grid.json", "--backend", "serial", "--size", "32x24", "--photons", "300", "--k", "16",
                    "-o", "a.pfm", "--stats", "stats.json"});
            EXPECT_EQ(run(more).code, 0);
            return nlohmann::json::parse(contents(folder / "stats.json"));
        };
        EXPECT_EQ(drawn({}).at("settings").at("map"), "auto");
        const auto s = drawn({"--grid", "32,1,32"});
        EXPECT_EQ(s.at("settings").at("map"), "sort");
        EXPECT_EQ(s.at("map").at("cells"), 32 * 32);
        for (const auto& both : {std::vector<std::string>{"--grid", "32,1,32", "--map", "auto"},
                 std::vector<std::string>{"--map", "auto", "--grid", "32,1,32"}})
            EXPECT_EQ(drawn(both).at("settings").at("map"), "auto") << "a map that is named stays";
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
        if (e.code == 4 && e.err.find("cpu: photongrid was built without it") != std::string::npos)
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
        EXPECT_TRUE(stats.at("notes").empty());
        EXPECT_GT(stats.at("kernels").at("bounce_photon").at("ms"), 0);
        EXPECT_EQ(contents(folder / "none.pfm"), contents(folder / "first.pfm"));
        EXPECT_EQ(contents(folder / "none.pfm"), contents(folder / "second.pfm"));
    }

    TEST_F(program, rejects_outputs_before_rendering)
    {
        EXPECT_EQ(run(small_with({"-o", "a.jpg"})).code, 5);
        EXPECT_EQ(run(small_with({"-o", "none/a.png"})).code, 5);
        EXPECT_EQ(run(small_with({"-o", "a.png", "--stats", "none/a.json"})).code, 5);
        EXPECT_EQ(files(), 0u);
    }

    TEST_F(program, takes_whole_numbers_with_exponents)
    {
        ASSERT_EQ(run(small_with({"-o", "a.pfm"})).code, 0);
        auto exponents = small_with({"-o", "b.pfm"});
        std::replace(exponents.begin(), exponents.end(), std::string("300"), std::string("3e2"));
        ASSERT_EQ(run(exponents).code, 0);
        EXPECT_EQ(contents(folder / "a.pfm"), contents(folder / "b.pfm"));
    }

    TEST_F(program, writes_each_file_once)
    {
        fs::copy(PHOTONGRID_SCENES "/ring.json", folder / "ring.json");
        const auto scene = contents(folder / "ring.json");
        for (const auto& [more, what] : std::vector<std::pair<std::vector<std::string>, std::string>>{
                 {{"-o", "a.png", "--stats", "a.png"}, "--stats: \"a.png\" is the file of -o too"},
                 {{"-o", "a.png", "-o", "./a.png"}, "-o: \"./a.png\" is the file of -o too"},
                 {{"-o", "a.png", "--strip", "../" + folder.filename().string() + "/a.png"}, "is the file of -o too"},
                 {{"--stats", "s", "--resume", "s"}, "--resume: \"s\" is the file of --stats too"},
                 {{"--stats", "ring.json"}, "--stats: \"ring.json\" is the scene"}}) {
            auto all = small_with(more);
            all[1] = "ring.json";
            const auto e = run(all);
            EXPECT_EQ(e.code, 2);
            EXPECT_NE(e.err.find(what), std::string::npos) << e.err;
        }
        const auto e = run({"reference", "ring.json", "-o", "a.pfm", "--error", "a.pfm"});
        EXPECT_EQ(e.code, 2);
        EXPECT_NE(e.err.find("--error: \"a.pfm\" is the file of -o too"), std::string::npos) << e.err;
        EXPECT_EQ(files(), 1u);
        EXPECT_EQ(contents(folder / "ring.json"), scene);
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
            EXPECT_EQ(s.at("map").at("blocks"), 0);
            EXPECT_TRUE(s.at("map").contains("overflowing_cells"));
            EXPECT_TRUE(s.at("map").contains("redistributed_power"));
            EXPECT_GT(s.at("stages").at("prepare_scene").at("ms"), 0);
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

} // namespace
} // namespace photongrid
