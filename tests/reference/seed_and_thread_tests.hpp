// Errors, seeds and threads.
#pragma once

#include "reference_under_test.hpp"

namespace photongrid {
namespace {

    // --- errors, seeds, threads ---
    bool same_bytes(const image& a, const image& b)
    {
        return a.pixels.size() == b.pixels.size()
            && std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)) == 0;
    }

    TEST(reference, same_seed_same_bytes_on_any_number_of_threads)
    {
        const auto s = testing::all_shapes();
        auto settings = quick(24, 16, 16);
        settings.paths = 100000;
        settings.threads = 1;
        const auto one = render_reference(s, s.camera, settings);
        for (const std::uint32_t threads : {2u, 3u}) {
            settings.threads = threads;
            const auto more = render_reference(s, s.camera, settings);
            EXPECT_TRUE(same_bytes(one.mean, more.mean)) << threads;
            EXPECT_TRUE(same_bytes(one.standard_error, more.standard_error)) << threads;
        }
        EXPECT_GT(one.stats.caustic_hits, 0u);
        settings.seed = 2;
        EXPECT_FALSE(same_bytes(one.mean, render_reference(s, s.camera, settings).mean));
    }

    void expect_honest_errors(const scene& s, reference_settings settings)
    {
        const int seeds = 40;
        std::vector<reference_picture> pictures;
        for (int i = 0; i < seeds; ++i) {
            settings.seed = static_cast<std::uint64_t>(100 + i);
            pictures.push_back(render_reference(s, s.camera, settings));
        }
        double spread = 0, said = 0;
        for (std::size_t p = 0; p < pictures[0].mean.pixels.size(); ++p) {
            double mean = 0, squares = 0;
            for (const auto& x : pictures)
                mean += static_cast<double>(x.mean.pixels[p].y) / seeds;
            for (const auto& x : pictures) {
                squares += std::pow(static_cast<double>(x.mean.pixels[p].y) - mean, 2);
                said += std::pow(static_cast<double>(x.standard_error.pixels[p].y), 2) / seeds;
            }
            spread += squares / (seeds - 1);
        }
        EXPECT_NEAR(std::sqrt(said / spread), 1, 0.15);
    }

    TEST(reference, standard_error_is_the_spread_of_seeds)
    {
        auto s = testing::small_cornell();
        auto settings = quick(8, 8, 32);
        s.materials[4].kind = s.materials[3].kind
            = material_kind::lambertian; // rare bright caustics by paths have a spread that 40 seeds do not show
        expect_honest_errors(s, settings);
        // With bins, whose errors all samples of a pixel share: a dark floor with a caustic and little else.
        scene c = empty_scene();
        c.polygons = {rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 1)};
        c.spheres = {{{0, 0.5, 0}, 0.4, 3}};
        c.point_lights = {{"lamp", {0, 2, 0}, dvec3(10)}};
        c.camera = {{0, 1.2, 1.2}, {0, 0, 0.1}, {0, 1, 0}, 15};
        settings = quick(8, 8, 64);
        settings.paths = 20000;
        settings.bin = 0.05;
        expect_honest_errors(c, settings);
    }

    TEST(reference, cancelling_and_mistakes_throw)
    {
        const auto s = testing::all_shapes();
        auto settings = quick(24, 16, 1000);
        settings.paths = 1000000;
        render_observer observer;
        int calls = 0;
        observer.cancelled = [&] { return ++calls > 3; };
        EXPECT_THROW(render_reference(s, s.camera, settings, observer), render_cancelled);
        observer.cancelled = {};
        double last = 0;
        observer.progress = [&](std::string_view stage, double fraction) {
            last = fraction;
            if (stage == "eye_paths")
                throw std::runtime_error("from the observer");
        };
        EXPECT_THROW(render_reference(s, s.camera, settings, observer), std::runtime_error);
        settings.spp = 1;
        EXPECT_THROW(render_reference(s, s.camera, settings), std::invalid_argument);
        settings = quick(4, 4, 4);
        settings.bin = -1;
        EXPECT_THROW(render_reference(s, s.camera, settings), std::invalid_argument);
        settings.bin = 1e-9;
        EXPECT_THROW(render_reference(s, s.camera, settings), std::invalid_argument);
    }

    TEST(reference, program_writes_mean_and_error)
    {
        namespace fs = std::filesystem;
        const fs::path folder = fs::temp_directory_path() / ("photongrid_reference_" + std::to_string(::getpid()));
        fs::create_directories(folder);
        const auto run = [&](const std::string& arguments) {
            const int status = std::system(("cd " + folder.string() + " && " + PHOTONGRID_PROGRAM + " reference "
                + PHOTONGRID_SCENES "/ring.json " + arguments + " >out 2>err")
                                               .c_str());
            return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        };
        EXPECT_EQ(run("-o a.exr --error e.pfm --size 16x12 --spp 16 --paths 20000 --seed 3 --stats s.json"), 0);
        const auto mean = read_image((folder / "a.exr").string()), error = read_image((folder / "e.pfm").string());
        const auto s = reference_settings_for(render_settings{.output = {.width = 16, .height = 12}, .seed = 3});
        EXPECT_EQ(mean.width, s.width);
        EXPECT_EQ(error.height, s.height);
        EXPECT_GT(fs::file_size(folder / "s.json"), 100u);
        EXPECT_EQ(run("-o b.exr --size 16x12 --spp 16 --paths 20000 --seed 3 --threads 3"), 0);
        EXPECT_TRUE(same_bytes(mean, read_image((folder / "b.exr").string())));
        EXPECT_EQ(run("--spp 16"), 2);
        EXPECT_EQ(run("-o c.exr --spp 1"), 2);
        EXPECT_EQ(run("-o c.exr --bin 0"), 2);
        EXPECT_EQ(run("-o no/such/folder.exr"), 5);
        EXPECT_EQ(run("-o c.txt"), 5);
        EXPECT_FALSE(fs::exists(folder / "c.exr"));
        fs::remove_all(folder);
    }

} // namespace
} // namespace photongrid
