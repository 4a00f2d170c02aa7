// The program's window under test: its process, mouse, keys and pixels.
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <X11/keysym.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

namespace fs = std::filesystem;
using json = nlohmann::json;

std::string contents(const fs::path& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

bool wait_until(const std::function<bool()>& good, std::chrono::seconds limit = std::chrono::seconds(60))
{
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!good()) {
        if (std::chrono::steady_clock::now() > end)
            return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
}

/// A process, killed with this object where it still runs.
class process {
public:
    process(std::vector<std::string> arguments, const fs::path& output,
        const std::vector<std::pair<std::string, std::string>>& environment, int keep_open = -1)
    {
        std::vector<char*> argv;
        for (auto& a : arguments)
            argv.push_back(a.data());
        argv.push_back(nullptr);
        id_ = ::fork();
        if (id_ == 0) {
            const int out = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
            ::dup2(out, 1);
            ::dup2(out, 2);
            if (keep_open > 2)
                ::fcntl(keep_open, F_SETFD, 0);
            for (const auto& [name, value] : environment)
                value.empty() ? ::unsetenv(name.c_str()) : ::setenv(name.c_str(), value.c_str(), 1);
            ::execvp(argv[0], argv.data());
            ::_exit(127);
        }
    }
    process(const process&) = delete;
    process& operator=(const process&) = delete;
    ~process()
    {
        if (id_ > 0) {
            ::kill(id_, SIGKILL);
            ::waitpid(id_, nullptr, 0);
        }
    }
    void signal(int number) const { ::kill(id_, number); }
    /// Waits for its end; -1: a minute went by, or it was ended by a signal.
    int code()
    {
        int status = 0;
        if (!wait_until([&] { return ::waitpid(id_, &status, WNOHANG) == id_; }))
            return -1;
        id_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    pid_t id_ = 0;
};

/// A floor and a wall with a ball before it, a lamp to the left. Seen from the front: the ball's shadow falls to the
/// right.
const char* const scene = R"({"photongrid": 1, "name": "ball", "units": {"length": "m", "power": "W"},
 "camera": {"position": [0, 1, 4], "look_at": [0, 0.6, 0], "vertical_fov": 40},
 "materials": {"white": {"type": "lambertian", "reflectance": 0.7}, "red": {"type": "lambertian", "reflectance": [0.7, 0.1, 0.1]}},
 "shapes": [{"type": "polygon", "vertices": [[-2, 0, -1], [-2, 0, 2], [2, 0, 2], [2, 0, -1]], "material": "white"},
  {"type": "polygon", "vertices": [[-2, 0, -1], [2, 0, -1], [2, 2, -1], [-2, 2, -1]], "material": "white"},
  {"type": "sphere", "center": [0, 0.4, 0], "radius": 0.4, "material": "red"}],
 "lights": [{"type": "rectangle", "name": "lamp", "corner": [-1.1, 1.3, -0.1], "edge_u": [0.3, 0, 0], "edge_v": [0, 0, 0.3], "power": [20, 20, 20]}],
 "render": {"size": [160, 120], "photons": 4000, "k": 60, "grid": [24, 12, 18], "max_radius": 0.4, "light_samples": 4}})";

/// Where its picture shows the middle of the lamp, in parts of the width and height. It is seen from its edge, a
/// hundredth of the height.
constexpr double lamp_x = 0.25, lamp_y = 0.256;

class window : public ::testing::Test {
protected:
    static constexpr int width = 1000, height = 800; // of the screen

    window() : folder(fs::temp_directory_path() / ("photongrid_window_" + std::to_string(::getpid())))
    {
        fs::create_directories(folder);
        std::ofstream(folder / "ball.json") << scene;
    }
    ~window() override
    {
        program.reset();
        if (x != nullptr)
            XCloseDisplay(x);
        server.reset();
        fs::remove_all(folder);
    }

    /// A display whose number is free.
    void open_display(const std::vector<std::string>& more = {})
    {
        int pipe[2];
        ASSERT_EQ(::pipe2(pipe, O_CLOEXEC), 0);
        std::vector<std::string> command{"Xvfb", "-displayfd", std::to_string(pipe[1]), "-screen", "0",
            std::to_string(width) + "x" + std::to_string(height) + "x24", "-nolisten", "tcp", "-noreset"};
        command.insert(command.end(), more.begin(), more.end());
        server = std::make_unique<process>(
            command, folder / "xvfb.log", std::vector<std::pair<std::string, std::string>>{}, pipe[1]);
        ::close(pipe[1]);
        // The server writes its number, then the end of the line; it fails where the pipe is closed in between.
        std::string line;
        for (char c = 0; c != '\n' && ::read(pipe[0], &c, 1) == 1;)
            line += c;
        ::close(pipe[0]);
        ASSERT_TRUE(line.ends_with('\n'))
            << "Xvfb (Debian package xvfb) does not start: " << contents(folder / "xvfb.log");
        display = ":" + std::to_string(std::atoi(line.c_str()));
        x = XOpenDisplay(display.c_str());
        ASSERT_NE(x, nullptr) << display << ": " << contents(folder / "xvfb.log");
        int event = 0, error = 0, major = 0, minor = 0;
        ASSERT_TRUE(XTestQueryExtension(x, &event, &error, &major, &minor));
    }

    void open_window(const std::vector<std::string>& more = {}, const std::string& backend = "serial")
    {
        std::vector<std::string> command{PHOTONGRID_PROGRAM, "view", (folder / scene_name).string(), "--backend",
            backend, "--journal", (folder / "journal").string()};
        command.insert(command.end(), more.begin(), more.end());
        fs::current_path(folder);
        program = std::make_unique<process>(command, folder / "program.log",
            std::vector<std::pair<std::string, std::string>>{{"DISPLAY", display}, {"WAYLAND_DISPLAY", ""}});
        ASSERT_TRUE(rests()) << contents(folder / "program.log");
    }

    // --- what happens ---
    std::vector<json> journal() const
    {
        std::vector<json> lines;
        std::istringstream all(contents(folder / "journal"));
        for (std::string line; std::getline(all, line);)
            if (auto j = json::parse(line, nullptr, false); !j.is_discarded())
                lines.push_back(std::move(j));
        return lines;
    }
    std::size_t requests() const
    {
        std::size_t n = 0;
        for (const auto& j : journal())
            n += j["event"] == "start" ? 1u : 0u;
        return n;
    }
    std::uint64_t maps() const
    {
        std::uint64_t n = 0;
        for (const auto& j : journal())
            if (j["event"] == "whole")
                n = j["maps"];
        return n;
    }
    /// The last request is drawn, and no other follows.
    bool is_drawn(std::size_t more_than = 0)
    {
        return wait_until([&] {
            std::string last;
            for (const auto& j : journal())
                if (j["event"] == "start" || j["event"] == "picture" || j["event"] == "whole" || j["event"] == "error")
                    last = j["event"];
            return requests() > more_than && last == "whole";
        });
    }
    /// As is_drawn(), and it is on the screen.
    bool rests(std::size_t more_than = 0)
    {
        const bool drawn = is_drawn(more_than);
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        return drawn;
    }

    // --- controls: of the panel and of questions, by label ---
    struct place {
        double x = 0, y = 0, width = 0, height = 0;
    };
    place control(const std::string& label) const
    {
        json places;
        for (const auto& j : journal())
            if (j["event"] == "controls")
                places = j["places"];
        EXPECT_TRUE(places.contains(label)) << label;
        if (!places.contains(label))
            return {};
        const auto& p = places[label];
        return {p[0], p[1], p[2], p[3]};
    }
    /// Clicks on a control, at a part of the width that a slider or box has without its label.
    void use(const std::string& label, double part = 0.1)
    {
        const auto c = control(label);
        click(static_cast<int>(c.x + part * std::min(c.width, 170.0)), static_cast<int>(c.y + c.height / 2));
    }
    /// Chooses a word of a box of words.
    void choose(const std::string& label, const std::string& word)
    {
        use(label);
        // Its words are where they stay from the second frame on, and frames follow events.
        const auto c = control(label);
        for (int i = 0; i < 3; ++i)
            mouse_to(static_cast<int>(c.x) + 10 + i, static_cast<int>(c.y) + 5);
        use(label + ": " + word);
    }

    /// The program's, which was opened last.
    Window top_window() const
    {
        Window root = 0, parent = 0, *children = nullptr;
        unsigned count = 0;
        EXPECT_NE(XQueryTree(x, DefaultRootWindow(x), &root, &parent, &children, &count), 0);
        EXPECT_GE(count, 1u);
        const Window last = count > 0 ? children[count - 1] : 0;
        XFree(children);
        return last;
    }
    /// As a window manager does when its button is pressed.
    void ask_to_close()
    {
        XEvent e{};
        e.xclient.type = ClientMessage;
        e.xclient.window = top_window();
        e.xclient.message_type = XInternAtom(x, "WM_PROTOCOLS", 0);
        e.xclient.format = 32;
        e.xclient.data.l[0] = static_cast<long>(XInternAtom(x, "WM_DELETE_WINDOW", 0));
        XSendEvent(x, e.xclient.window, 0, NoEventMask, &e);
        pause();
    }

    // --- mouse and keys ---
    void mouse_to(int px, int py) const
    {
        XTestFakeMotionEvent(x, -1, px, py, 0);
        pause();
    }
    void button(unsigned number, bool down) const
    {
        XTestFakeButtonEvent(x, number, down ? 1 : 0, 0);
        pause();
    }
    void click(int px, int py, unsigned number = 1) const
    {
        mouse_to(px, py);
        button(number, true);
        button(number, false);
    }
    void hold(KeySym symbol, bool down) const
    {
        XTestFakeKeyEvent(x, XKeysymToKeycode(x, symbol), down ? 1 : 0, 0);
        pause();
    }
    void drag(int from_x, int from_y, int to_x, int to_y, unsigned number = 1) const
    {
        mouse_to(from_x, from_y);
        button(number, true);
        for (int step = 1; step <= 4; ++step)
            mouse_to(from_x + (to_x - from_x) * step / 4, from_y + (to_y - from_y) * step / 4);
        button(number, false);
    }
    void key(KeySym symbol, bool control = false) const
    {
        const auto press = [&](KeySym s, int down) { XTestFakeKeyEvent(x, XKeysymToKeycode(x, s), down, 0); };
        if (control)
            press(XK_Control_L, 1);
        press(symbol, 1);
        pause();
        press(symbol, 0);
        if (control)
            press(XK_Control_L, 0);
        pause();
    }
    /// Longer than the window takes to look at events: clicks that come and go in between are not its users'.
    void pause() const
    {
        XSync(x, 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(120));
    }

    // --- picking ---
    /// The picture's part of the screen, rgb.
    struct screenshot {
        std::vector<unsigned char> bytes;
        int left = 0, top = 0, width = 0, height = 0;

        double brightness(double from_x, double to_x, double from_y, double to_y) const
        {
            double sum = 0;
            int n = 0;
            for (int py = static_cast<int>(from_y * height); py < static_cast<int>(to_y * height); ++py)
                for (int px = static_cast<int>(from_x * width); px < static_cast<int>(to_x * width); ++px, ++n)
                    for (int c = 0; c < 3; ++c)
                        sum += bytes[static_cast<std::size_t>((py * width + px) * 3 + c)];
            return sum / (3.0 * n);
        }
    };
    screenshot take_screenshot() const
    {
        screenshot s;
        s.width = picture_width, s.height = picture_height, s.left = picture_left, s.top = picture_top;
        XImage* im = XGetImage(x, DefaultRootWindow(x), s.left, s.top, static_cast<unsigned>(s.width),
            static_cast<unsigned>(s.height), AllPlanes, ZPixmap);
        EXPECT_NE(im, nullptr);
        for (int py = 0; py < s.height; ++py)
            for (int px = 0; px < s.width; ++px) {
                const unsigned long p = XGetPixel(im, px, py);
                for (const int shift : {16, 8, 0})
                    s.bytes.push_back(static_cast<unsigned char>(p >> shift & 0xFF));
            }
        XDestroyImage(im);
        return s;
    }
    /// Share of the bytes that differ by more than a little.
    static double difference(const screenshot& a, const screenshot& b)
    {
        std::size_t n = 0;
        for (std::size_t i = 0; i < a.bytes.size(); ++i)
            n += std::abs(a.bytes[i] - b.bytes[i]) > 4 ? 1u : 0u;
        return static_cast<double>(n) / static_cast<double>(a.bytes.size());
    }

    // The window is 810 x 720, at the screen's corner, since no window manager puts it elsewhere; its picture, 480 x
    // 360, has the panel's 330 pixels to its right.
    int picture_width = 480, picture_height = 360, picture_left = 0, picture_top = 180;
    /// From parts of the picture to pixels of the screen.
    int px(double part) const { return picture_left + static_cast<int>(part * picture_width); }
    int py(double part) const { return picture_top + static_cast<int>(part * picture_height); }

    /// As its user does by its border. The picture stays 4 : 3, in the middle of what the panel leaves.
    void resize(int new_width, int new_height)
    {
        XResizeWindow(x, top_window(), static_cast<unsigned>(new_width), static_cast<unsigned>(new_height));
        const double room_x = std::max(1, new_width - 330), room_y = new_height,
                     scale = std::min(room_x / 4, room_y / 3);
        picture_width = static_cast<int>(4 * scale), picture_height = static_cast<int>(3 * scale);
        picture_left = static_cast<int>((room_x - picture_width) / 2);
        picture_top = static_cast<int>((room_y - picture_height) / 2);
        pause();
    }

    fs::path folder;
    std::string scene_name = "ball.json", display;
    Display* x = nullptr;
    std::unique_ptr<process> server, program;
};

} // namespace
