// Backends, interrupts, full disks and progress.
#pragma once

#include "module_tests.hpp"

namespace photongrid {
namespace {

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
        EXPECT_EQ(line, "picture,ms,relmse,ssim");
        std::vector<double> times, errors, likeness;
        while (std::getline(table, line)) {
            char name[64];
            double ms = 0, relmse = 0, ssim = 0;
            ASSERT_EQ(std::sscanf(line.c_str(), "%63[^,],%lf,%lf,%lf", name, &ms, &relmse, &ssim), 4) << line;
            EXPECT_TRUE(fs::exists(folder / "steps" / name)) << line;
            times.push_back(ms);
            errors.push_back(relmse);
            likeness.push_back(ssim);
        }
        ASSERT_EQ(times.size(), pictures);
        EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
        EXPECT_GT(errors.front(), 0);
        EXPECT_EQ(errors.back(), 0);
        EXPECT_LT(likeness.front(), 1);
        EXPECT_EQ(likeness.back(), 1);
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
        const auto devices = run({"devices"}).out;
        const bool has_hardware = e.err.find("--backend auto: vulkan, device ") != std::string::npos,
                   has_cpu = devices.find("cpu: photongrid was built without it") == std::string::npos;
        const std::string why = is_built(parts[0]) ? "no hardware Vulkan device" : "vulkan is not built";
        EXPECT_TRUE(has_hardware
            || e.err.find(
                   "--backend auto: " + (has_cpu ? "cpu (" + why + ")\n" : "serial (" + why + ", built without cpu)\n"))
                != std::string::npos)
            << e.err << devices;
    }

    // A file-size limit simulates a full disk. Of two pictures the first fits.
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
                "--photons", "300", "--caustic-photons", "0", "-o", "a.pfm", "--stats", "a.json"});
            std::this_thread::sleep_for(std::chrono::milliseconds(700));
            interrupt(child, signal);
            const auto e = wait(child);
            EXPECT_EQ(e.code, 130) << e.err;
            EXPECT_NE(e.err.find("interrupted at 0 %"), std::string::npos) << e.err;
            EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(30));
            ASSERT_EQ(files(), 1u) << "statistics of an unfinished picture, or a part of a file";
            const auto kept = read_image((folder / "a.pfm").string());
            ASSERT_EQ(run({"render", ring, "--backend", "serial", "--size", "64x64", "--photons", "300",
                              "--caustic-photons", "0", "-o", "b.pfm"})
                          .code,
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
            interrupt(child);
            const auto e = wait(child);
            if (e.code == 0)
                break;
            ASSERT_EQ(e.code, 130) << e.err;
            if (fs::exists(folder / "unfinished")) {
                ++interruptions;
                EXPECT_NE(e.err.find("run the same command again to resume from unfinished"), std::string::npos)
                    << e.err;
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
        EXPECT_FALSE(fs::exists(folder / "unfinished")) << "the picture is complete";
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
        EXPECT_EQ(table.substr(0, table.find('\n')), "picture,ms,relmse,ssim,relmse_to_reference,ssim_to_reference");
        EXPECT_EQ(table.substr(table.size() - 9), ",0,1,0,1\n");

        EXPECT_EQ(run(small_with({"--strip", "strip.pfm", "--crop", "10x8+60+2"})).code, 2);
        EXPECT_EQ(run(small_with({"--progressive", "steps", "--reference", "strip.pfm"})).code, 2);
    }

} // namespace
} // namespace photongrid
