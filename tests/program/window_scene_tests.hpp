// Scenes that come while the window is open: files dropped onto it, and files that change.
#pragma once

#include "window_under_test.hpp"

#include <X11/Xatom.h>

namespace {

/// A window, and files for it.
class window_of_scenes : public window {
protected:
    void write(const std::string& name, const std::string& content) const
    {
        std::ofstream(folder / name, std::ios::binary) << content;
    }
    /// The scene of the window's tests, after a change.
    static std::string changed(const std::string& from, const std::string& to)
    {
        std::string text = scene;
        text.replace(text.find(from), from.size(), to);
        return text;
    }
    std::size_t count(const std::string& event) const
    {
        std::size_t n = 0;
        for (const auto& j : journal())
            n += j["event"] == event ? 1u : 0u;
        return n;
    }
    /// A detail of the last event of a kind.
    std::string last(const std::string& event, const char* detail) const
    {
        std::string text;
        for (const auto& j : journal())
            if (j["event"] == event)
                text = j.value(detail, "");
        return text;
    }
    /// Does something, and waits until it makes an event.
    void makes(const std::string& event, const std::function<void()>& act)
    {
        const auto before = count(event);
        act();
        ASSERT_TRUE(wait_until([&] { return count(event) > before; })) << event << contents(folder / "program.log");
        pause(); // until the window shows it
    }

    /// Drags files from another program's window and drops them, by the protocol of X (XDND, version 5).
    void drop(const std::vector<std::string>& names)
    {
        std::string list;
        for (const auto& name : names) {
            list += "file://";
            for (const char c : (folder / name).string())
                list += c == ' ' ? std::string("%20") : std::string(1, c);
            list += "\r\n";
        }
        const auto atom = [&](const char* name) { return XInternAtom(x, name, 0); };
        const auto target = top_window(), source = XCreateSimpleWindow(x, DefaultRootWindow(x), 0, 0, 1, 1, 0, 0, 0);
        XSetSelectionOwner(x, atom("XdndSelection"), source, CurrentTime);
        const auto tell = [&](const char* what, long a = 0, long b = 0, long c = 0, long d = 0) {
            XEvent e{};
            e.xclient.type = ClientMessage;
            e.xclient.window = target;
            e.xclient.message_type = atom(what);
            e.xclient.format = 32;
            const long data[] = {static_cast<long>(source), a, b, c, d};
            std::copy(std::begin(data), std::end(data), e.xclient.data.l);
            XSendEvent(x, target, 0, NoEventMask, &e);
        };
        tell("XdndEnter", 5L << 24, static_cast<long>(atom("text/uri-list")));
        tell("XdndPosition", 0, (100L << 16) | 300L, CurrentTime, static_cast<long>(atom("XdndActionCopy")));
        tell("XdndDrop", 0, CurrentTime);
        XFlush(x);
        // The window asks for the list, takes it, and says so.
        EXPECT_TRUE(wait_until([&] {
            while (XPending(x) > 0) {
                XEvent e;
                XNextEvent(x, &e);
                if (e.type == ClientMessage && e.xclient.message_type == atom("XdndFinished"))
                    return true;
                if (e.type != SelectionRequest)
                    continue;
                const auto& asked = e.xselectionrequest;
                XChangeProperty(x, asked.requestor, asked.property, asked.target, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(list.data()), static_cast<int>(list.size()));
                XEvent answer{};
                answer.xselection.type = SelectionNotify;
                answer.xselection.requestor = asked.requestor;
                answer.xselection.selection = asked.selection;
                answer.xselection.target = asked.target;
                answer.xselection.property = asked.property;
                answer.xselection.time = asked.time;
                XSendEvent(x, asked.requestor, 0, NoEventMask, &answer);
                XFlush(x);
            }
            return false;
        })) << "the files were not taken";
        XDestroyWindow(x, source);
        XSync(x, 0);
    }
    /// All but the panel.
    screenshot screenshot_with_messages()
    {
        const int high = std::exchange(picture_height, 720), top = std::exchange(picture_top, 0);
        auto s = take_screenshot();
        picture_height = high, picture_top = top;
        return s;
    }
    /// Without numbers, which go on while the picture rests, and off the panel.
    screenshot first_screenshot()
    {
        key(XK_o);
        mouse_to(px(0.1), py(0.2));
        return take_screenshot();
    }
};

/// A floor, a square of a mesh that stands before it, and a bulb, in the language of pbrt.
const char* const pbrt_scene = R"(LookAt 0 1 4  0 0.6 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 160 "integer yresolution" 120
WorldBegin
LightSource "point" "rgb I" [ 20 20 20 ] "point3 from" [ 1 2 3 ]
Material "diffuse" "rgb reflectance" [ 0.7 0.7 0.7 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -1  -2 0 2  2 0 -1  2 0 2 ]
Material "diffuse" "rgb reflectance" [ 0.1 0.7 0.1 ]
Shape "plymesh" "string filename" "square.ply"
)";
std::string square(double width)
{
    const auto w = std::to_string(width);
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n-"
        + w + " 0 0\n" + w + " 0 0\n" + w + " 1 0\n-" + w + " 1 0\n4 0 1 2 3\n";
}

TEST_F(window_of_scenes, a_scene_that_changes_is_read_again)
{
    ASSERT_NO_FATAL_FAILURE(open_display());
    ASSERT_NO_FATAL_FAILURE(open_window({}, "cpu"));
    const auto first = first_screenshot();

    // The camera is turned, and then the ball becomes white: the view stays.
    auto before = requests();
    drag(px(0.1), py(0.2), px(0.2), py(0.2));
    ASSERT_TRUE(rests(before));
    const auto turned = take_screenshot();
    ASSERT_GT(difference(turned, first), 0.05);
    const std::string ball = "\"radius\": 0.4, \"material\": \"red\"",
                      white = "\"radius\": 0.4, \"material\": \"white\"";
    before = requests();
    ASSERT_NO_FATAL_FAILURE(makes("read again", [&] { write("ball.json", changed(ball, white)); }));
    ASSERT_TRUE(rests(before));
    const auto whitened = take_screenshot();
    EXPECT_GT(difference(whitened, turned), 0.01) << "the picture is that of the file before";
    EXPECT_LT(difference(whitened, turned), difference(whitened, first)) << "the camera went back";

    // Broken, it stays and says where; mended, it goes on.
    before = requests();
    ASSERT_NO_FATAL_FAILURE(
        makes("refused", [&] { write("ball.json", changed(ball, "\"radius\": 0.4, \"material\": 7")); }));
    EXPECT_NE(last("refused", "why").find("ball.json:6:"), std::string::npos) << last("refused", "why");
    EXPECT_LT(difference(take_screenshot(), whitened), 0.001) << "the picture went";
    key(XK_k);
    ASSERT_TRUE(is_drawn(before)) << "the window no longer follows";
    before = requests();
    key(XK_z, true);
    ASSERT_TRUE(is_drawn(before));
    before = requests();
    ASSERT_NO_FATAL_FAILURE(makes("read again", [&] { write("ball.json", scene); }));
    ASSERT_TRUE(rests(before));
    EXPECT_LT(difference(take_screenshot(), turned), 0.001) << "mended, it is not the first scene from the new camera";
    program->signal(SIGINT);
    EXPECT_EQ(program->code(), 0) << contents(folder / "program.log");
}

TEST_F(window_of_scenes, what_was_moved_is_not_lost_in_silence)
{
    ASSERT_NO_FATAL_FAILURE(open_display());
    ASSERT_NO_FATAL_FAILURE(open_window({}, "cpu"));
    const auto first = first_screenshot();
    auto before = requests();
    click(px(lamp_x), py(lamp_y));
    drag(px(lamp_x), py(lamp_y), px(0.73), py(lamp_y));
    key(XK_Escape);
    mouse_to(px(0.1), py(0.2));
    ASSERT_TRUE(rests(before));
    const auto moved = take_screenshot();
    ASSERT_GT(difference(moved, first), 0.02);
    ASSERT_NO_FATAL_FAILURE(makes("asks", [&] { write("ball.json", std::string(scene) + "\n"); }));
    EXPECT_EQ(last("asks", "about"), "reading again");
    use("stay");
    mouse_to(px(0.1), py(0.2));
    EXPECT_LT(difference(take_screenshot(), moved), 0.001) << "it did not stay";
    ASSERT_NO_FATAL_FAILURE(makes("asks", [&] { write("ball.json", std::string(scene) + "\n\n"); }));
    before = requests();
    ASSERT_NO_FATAL_FAILURE(makes("read again", [&] { use("save scene and read again"); }));
    ASSERT_TRUE(is_drawn(before));
    mouse_to(px(0.1), py(0.2));
    ASSERT_TRUE(rests());
    EXPECT_LT(difference(take_screenshot(), first), 0.001) << "the lamp is not where its file has it";
    const auto saved = json::parse(contents(folder / "ball-changed.json"), nullptr, false);
    ASSERT_TRUE(saved.is_object()) << "what was moved is not saved";
    EXPECT_GT(saved["lights"][0]["corner"][0], 0);
    ask_to_close();
    EXPECT_EQ(program->code(), 0) << "nothing is changed, and it asks";
}

TEST_F(window_of_scenes, dropped_files_are_opened)
{
    ASSERT_NO_FATAL_FAILURE(open_display());
    ASSERT_NO_FATAL_FAILURE(open_window({"--photons", "500", "--k", "20"}, "cpu")); // of each scene
    const auto first = first_screenshot(), without_message = screenshot_with_messages();

    // What is no scene leaves the present one.
    write("bad.json", changed("\"radius\": 0.4", "\"radius\": -0.4"));
    write("sky.hdr", "");
    for (const auto& [name, says] : {std::pair{"bad.json", "bad.json:6:"}, {"sky.hdr", "is a picture, not a scene"},
             {"missing.json", "cannot be read"}}) {
        ASSERT_NO_FATAL_FAILURE(makes("refused", [&, file = name] { drop({file}); }));
        EXPECT_NE(last("refused", "why").find(says), std::string::npos) << last("refused", "why");
        EXPECT_GT(difference(screenshot_with_messages(), without_message), 0.01) << name << ": it does not say why";
        key(XK_Escape);
        EXPECT_LT(difference(screenshot_with_messages(), without_message), 0.001) << name;
    }

    // A scene of pbrt, dropped beside a picture.
    write("a square.pbrt", pbrt_scene);
    write("square.ply", square(0.4));
    auto before = requests();
    ASSERT_NO_FATAL_FAILURE(makes("opened", [&] { drop({"sky.hdr", "a square.pbrt"}); }));
    EXPECT_EQ(last("opened", "scene"), (folder / "a square.pbrt").string());
    ASSERT_TRUE(rests(before));
    const auto narrow = take_screenshot();
    EXPECT_GT(difference(narrow, first), 0.2);
    before = requests();
    ASSERT_NO_FATAL_FAILURE(makes("read again", [&] { write("square.ply", square(0.8)); }));
    ASSERT_TRUE(rests(before));
    EXPECT_GT(difference(take_screenshot(), narrow), 0.02) << "its mesh changed, and the picture did not";

    // With changes that are not saved, it asks.
    before = requests();
    key(XK_k);
    ASSERT_TRUE(is_drawn(before));
    ASSERT_NO_FATAL_FAILURE(makes("asks", [&] { drop({"ball.json"}); }));
    EXPECT_EQ(last("asks", "about"), "opening");
    use("stay");
    ASSERT_NO_FATAL_FAILURE(makes("asks", [&] { drop({"ball.json"}); }));
    EXPECT_EQ(count("opened"), 1u) << "it did not stay";
    before = requests();
    ASSERT_NO_FATAL_FAILURE(makes("opened", [&] { use("open without saving"); }));
    ASSERT_TRUE(is_drawn(before));
    mouse_to(px(0.1), py(0.2));
    ASSERT_TRUE(rests());
    EXPECT_LT(difference(take_screenshot(), first), 0.001) << "it is not as it was when it was opened first";
    ask_to_close();
    EXPECT_EQ(program->code(), 0) << "nothing is changed, and it asks";
}

TEST_F(window_of_scenes, shows_a_scene_of_pbrt)
{
    write("square.pbrt", pbrt_scene);
    write("square.ply", square(0.4));
    scene_name = "square.pbrt";
    ASSERT_NO_FATAL_FAILURE(open_display());
    ASSERT_NO_FATAL_FAILURE(open_window({"--photons", "500", "--k", "20", "--no-reload"}, "cpu"));
    // The camera looks straight at (0, 0.6, 0), where the green square is, 0.8 wide and from the floor up to 1.
    const auto s = first_screenshot();
    const auto colour = [&](double part, double down, int channel) {
        const int at = static_cast<int>(down * s.height) * s.width + static_cast<int>(part * s.width);
        return static_cast<int>(s.bytes[static_cast<std::size_t>(3 * at + channel)]);
    };
    EXPECT_GT(colour(0.5, 0.5, 1), 2 * colour(0.5, 0.5, 0));
    EXPECT_GT(colour(0.5, 0.5, 1), 2 * colour(0.5, 0.5, 2));
    EXPECT_NEAR(colour(0.1, 0.75, 1), colour(0.1, 0.75, 0), 40) << "the floor is grey";
    EXPECT_LT(colour(0.1, 0.2, 1), 10) << "behind all is nothing";

    // It can be changed, but not saved.
    auto before = requests();
    key(XK_k);
    ASSERT_TRUE(is_drawn(before));
    ASSERT_NO_FATAL_FAILURE(makes("asks", [&] { ask_to_close(); }));
    use("save scene and close");
    before = requests();
    key(XK_k);
    ASSERT_TRUE(is_drawn(before)) << "it closed, or still asks";
    EXPECT_EQ(count("read again"), 0u);
    for (const auto& entry : fs::directory_iterator(folder))
        EXPECT_EQ(entry.path().string().find("-changed"), std::string::npos) << entry.path();
    ASSERT_NO_FATAL_FAILURE(makes("asks", [&] { ask_to_close(); }));
    use("close without saving");
    EXPECT_EQ(program->code(), 0) << contents(folder / "program.log");
}

} // namespace
