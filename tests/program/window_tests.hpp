// The window follows mouse and keys.
#pragma once

#include "window_under_test.hpp"

namespace {

// One long test, since a display and a window take longer to open than all that follows.
TEST_F(window, follows_camera_lamp_and_keys)
{
    ASSERT_NO_FATAL_FAILURE(open_display());
    ASSERT_NO_FATAL_FAILURE(open_window());
    key(XK_o);                  // no numbers over the picture, which go on while it rests
    mouse_to(px(0.1), py(0.2)); // off the panel, whose tips reach into the picture
    const auto first = take_screenshot();
    const auto maps_at_first = maps();
    // The lamp is left, the shadow right of the ball: on the floor beside it.
    EXPECT_GT(first.brightness(0.2, 0.35, 0.66, 0.74), first.brightness(0.6, 0.72, 0.66, 0.74) + 10);

    // The camera moves: another picture, no other map.
    auto before = requests();
    drag(px(0.1), py(0.2), px(0.2), py(0.2));
    ASSERT_TRUE(rests(before));
    EXPECT_GT(difference(take_screenshot(), first), 0.05) << "the camera did not turn";
    EXPECT_EQ(maps(), maps_at_first) << "photons were traced for a camera that moved";
    before = requests();
    drag(px(0.1), py(0.2), px(0.1), py(0.3), 3);
    ASSERT_TRUE(rests(before));
    EXPECT_EQ(maps(), maps_at_first);
    key(XK_z, true);
    key(XK_z, true);
    ASSERT_TRUE(rests(before + 1));
    EXPECT_LT(difference(take_screenshot(), first), 0.001) << "undone, it is the first picture again";

    // The lamp is taken and moved to the right: photons are traced anew, and the shadow falls to the left.
    before = requests();
    click(px(lamp_x), py(lamp_y));
    EXPECT_EQ(requests(), before) << "to select is not to draw";
    drag(px(lamp_x), py(lamp_y), px(0.73), py(lamp_y));
    ASSERT_TRUE(rests(before));
    const auto moved = take_screenshot();
    EXPECT_GT(maps(), maps_at_first);
    EXPECT_GT(moved.brightness(0.6, 0.75, 0.66, 0.74), moved.brightness(0.28, 0.4, 0.66, 0.74) + 10)
        << "the shadow did not go with the lamp";

    // A key for a setting: k halves; another one undoes it and the lamp.
    before = requests();
    key(XK_Escape);
    key(XK_k);
    ASSERT_TRUE(rests(before));
    key(XK_z, true);
    key(XK_z, true);
    ASSERT_TRUE(rests(before + 1));
    EXPECT_LT(difference(take_screenshot(), first), 0.001);

    // The exposure changes the screen and draws nothing.
    before = requests();
    key(XK_e);
    EXPECT_LT(take_screenshot().brightness(0, 1, 0, 1), first.brightness(0, 1, 0, 1) - 5);
    EXPECT_EQ(requests(), before);

    // Pictures and scene are saved.
    key(XK_p);
    key(XK_s, true);
    EXPECT_TRUE(wait_until([&] {
        return fs::exists(folder / "ball.png") && fs::exists(folder / "ball.exr")
            && fs::exists(folder / "ball-changed.json");
    }));

    // Every cancelled drawing ended within a step.
    for (const auto& j : journal()) {
        EXPECT_NE(j["event"], "error") << j;
        if (j["event"] == "start" && j["moving"] == false) {
            EXPECT_LE(j["passes_waited"], 400) << j; // of the longest step: a sort of 2^16 photons takes 136
        }
    }
    program->signal(SIGINT);
    EXPECT_EQ(program->code(), 0) << contents(folder / "program.log");
}

TEST_F(window, says_what_is_missing)
{
    const auto view = [&](const std::string& on) {
        process p({PHOTONGRID_PROGRAM, "view", (folder / "ball.json").string(), "--backend", "serial"},
            folder / "program.log", {{"DISPLAY", on}, {"WAYLAND_DISPLAY", ""}});
        EXPECT_EQ(p.code(), 4);
        return contents(folder / "program.log");
    };
    const auto without = view("");
    EXPECT_NE(without.find("xvfb-run"), std::string::npos) << without;
    ASSERT_NO_FATAL_FAILURE(open_display({"-extension", "GLX"}));
    const auto blind = view(display);
    EXPECT_NE(blind.find("apt install libgl1-mesa-dri"), std::string::npos) << blind;
}

} // namespace
