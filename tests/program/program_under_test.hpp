// The program under test.
#pragma once

#include <photongrid/compare/image_difference.hpp>
#include <photongrid/io/image_file.hpp>
#include <photongrid/io/tone_map.hpp>

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
        /// Sends a signal once the process has a handler for it: one that comes earlier would end it.
        static void interrupt(pid_t child, int signal = SIGINT)
        {
            const auto handles_it = [&] {
                std::ifstream status("/proc/" + std::to_string(child) + "/status");
                for (std::string word; status >> word;)
                    if (word == "State:" && status >> word && word == "Z") {
                        return true; // it has ended
                    } else if (word == "SigCgt:") {
                        std::uint64_t caught = 0;
                        status >> std::hex >> caught;
                        return (caught >> (signal - 1) & 1) != 0;
                    }
                return true;
            };
            for (int ms = 0; !handles_it() && ms < 60000; ++ms)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            ::kill(child, signal);
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
        /// Runs a render that writes stats.json, and compares some of the settings in that file.
        void expect_settings(const std::vector<std::string>& arguments, const nlohmann::json& expected) const
        {
            const auto e = run(arguments);
            ASSERT_EQ(e.code, 0) << e.err;
            const auto settings = nlohmann::json::parse(contents(folder / "stats.json")).at("settings");
            for (const auto& [key, value] : expected.items())
                EXPECT_EQ(settings.at(key), value) << key << " of " << nlohmann::json(arguments);
        }
        std::size_t files() const
        {
            return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
        }

        fs::path folder;
        const std::string ring
            = PHOTONGRID_ONE_PASS_RING; ///< examples/scenes/ring.json with numbers: one pass of 4 eye rays
        /// Small enough for every test run.
        const std::vector<std::string> small{"render", ring, "--backend", "serial", "--size", "32x24",
            "--caustic-photons", "0", "--photons", "300", "--k", "16", "--grid", "32,1,32"};
        std::vector<std::string> small_with(std::vector<std::string> more) const
        {
            more.insert(more.begin(), small.begin(), small.end());
            return more;
        }
    };

} // namespace
} // namespace photongrid
