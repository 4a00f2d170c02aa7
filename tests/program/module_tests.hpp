// Libraries that the program needs for some of its work only: where one is missing or broken, the rest works.
#pragma once

#include "program_under_test.hpp"

namespace photongrid {
namespace {

    /// A variable of the environment, for as long as this lives.
    class variable {
    public:
        variable(const char* name, const std::string& value) : name_(name)
        {
            if (const char* const before = std::getenv(name))
                before_ = before;
            ::setenv(name, value.c_str(), 1);
        }
        variable(const variable&) = delete;
        variable& operator=(const variable&) = delete;
        ~variable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }

    private:
        const char* name_;
        std::optional<std::string> before_;
    };

    /// A backend or the window, and a library of which its module is made.
    struct part {
        const char* name;
        const char* library;
    };
    constexpr part parts[] = {{"vulkan", "libvulkan.so.1"}, {"gl", "libEGL.so.1"}, {"gl-osmesa", "libOSMesa.so.8"},
        {"window", "libglfw.so.3"}};
    bool is_built(const part& p)
    {
        const std::string name = p.name;
        return fs::exists(fs::path(PHOTONGRID_PROGRAM).parent_path() / "photongrid-modules"
            / ((name == "gl-osmesa" ? "gl" : name) + ".so"));
    }

    TEST_F(program, runs_where_a_library_is_broken)
    {
        for (const auto& p : parts) {
            if (!is_built(p))
                continue;
            SCOPED_TRACE(p.library);
            const auto broken = folder.string() + "-broken";
            fs::create_directories(broken);
            std::ofstream(fs::path(broken) / p.library) << "no library";
            const char* const others = std::getenv("LD_LIBRARY_PATH");
            const variable libraries("LD_LIBRARY_PATH", broken + (others ? ":" + std::string(others) : ""));
            const auto drawn = run(small_with({"-o", "ring.png"}));
            EXPECT_EQ(drawn.code, 0) << drawn.err;
            EXPECT_TRUE(fs::exists(folder / "ring.png"));
            const auto devices = run({"devices"});
            EXPECT_EQ(devices.code, 0) << devices.err;
            EXPECT_NE(devices.out.find("serial  this CPU"), std::string::npos);
            const bool is_window = p.name == std::string("window");
            const auto asked = is_window ? run({"view", ring, "--backend", "serial"})
                                         : run({"render", ring, "--backend", p.name, "--size", "8x6"});
            EXPECT_EQ(asked.code, 4);
            EXPECT_EQ(run({"render", ring, "--size", "8x6", "--photons", "100", "-o", "auto.png"}).code, 0);
            for (const auto& text : is_window ? std::vector{asked.err} : std::vector{asked.err, devices.out}) {
                EXPECT_NE(text.find(p.library), std::string::npos) << text;
                EXPECT_NE(text.find("apt install"), std::string::npos) << text;
            }
            fs::remove_all(broken);
            fs::remove(folder / "ring.png");
            fs::remove(folder / "auto.png");
        }
    }

    TEST_F(program, runs_without_its_modules)
    {
        const auto alone = folder / "alone";
        fs::copy_file(PHOTONGRID_PROGRAM, alone);
        const auto command = alone.string() + " devices >" + (folder / "devices").string();
        ASSERT_EQ(std::system(command.c_str()), 0);
        const auto said = contents(folder / "devices");
        EXPECT_NE(said.find("  this CPU"), std::string::npos) << said; // cpu, or serial in a build without
        for (const auto& p : parts)
            if (is_built(p) && p.name != std::string("window")) {
                EXPECT_NE(said.find(std::string(p.name) + "  not available"), std::string::npos) << said;
                EXPECT_NE(said.find("keep the program with its modules"), std::string::npos) << said;
            }
    }

    // A build has its modules only when they were asked for: examples/run.sh.
    TEST_F(program, says_how_its_modules_are_built)
    {
        const auto alone = folder / "alone";
        fs::copy_file(PHOTONGRID_PROGRAM, alone);
        fs::create_directory(folder / "photongrid-modules");
        const auto asked = [&](const std::string& arguments, int code) {
            const auto command = "cd " + folder.string() + " && ./alone " + arguments + " >said 2>&1";
            EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), code) << command;
            return contents(folder / "said");
        };
        for (const auto& p : parts)
            if (is_built(p)) {
                const bool is_window = p.name == std::string("window");
                const auto said
                    = asked((is_window ? "view " : std::string("render --backend ") + p.name + " ") + ring, 4);
                const bool is_osmesa = p.name == std::string("gl-osmesa"); // in the module of gl
                EXPECT_NE(
                    said.find(is_window ? "`examples/run.sh --view`"
                                        : std::string("`examples/run.sh --backend ") + (is_osmesa ? "gl" : p.name)),
                    std::string::npos)
                    << said;
            }
        const auto devices = asked("devices", 0);
        EXPECT_NE(devices.find("  this CPU"), std::string::npos) << devices;
        const auto chosen = asked("render --backend auto --size 8x6 --photons 100 -o auto.png " + ring, 0);
        EXPECT_NE(chosen.find("(vulkan is not built"), std::string::npos) << chosen;
    }

} // namespace
} // namespace photongrid
