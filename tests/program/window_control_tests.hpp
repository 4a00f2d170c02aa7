// All that the window lets its user do: each control, the mouse, keys of other layouts, saving and closing.
#pragma once

#include "window_under_test.hpp"

#include <map>
#include <sstream>

namespace {

/// What the window saved last, by key of "render", or as a whole.
json saved_scene(const fs::path& folder, const std::string& name = "ball-changed.json")
{
    EXPECT_TRUE(wait_until([&] { return fs::exists(folder / name); })) << name;
    return json::parse(contents(folder / name), nullptr, false);
}

TEST_F(window, controls_change_the_setting_they_name)
{
    ASSERT_NO_FATAL_FAILURE(open_display());
    ASSERT_NO_FATAL_FAILURE(open_window({"--size", "64x48", "--photons", "500"}));
    // Label, where to click (a part of the slider), the setting in files.
    const std::tuple<const char*, double, const char*> sliders[] = {{"photons", 0.3, "photons"}, {"k", 0.3, "k"},
        {"max radius", 0.6, "max_radius"}, {"grid", 0.1, "grid"}, {"spp", 0.3, "spp"}, {"passes", 0.2, "passes"},
        {"light samples", 0.5, "light_samples"}, {"side", 0.05, "leaks"}};
    for (const auto& [label, part, setting] : sliders) {
        const auto before = requests();
        use(label, part);
        EXPECT_TRUE(is_drawn(before)) << label;
    }
    const std::pair<const char*, const char*> words[] = {{"search", "fixed_radius"}, {"filter", "cone"},
        {"bias", "paper"}, {"map", "route"}, {"only", "indirect"}, {"backend", "cpu"}};
    for (const auto& [label, word] : words) {
        const auto before = requests();
        choose(label, word);
        EXPECT_TRUE(is_drawn(before)) << label;
    }
    pause(); // with a routed map there are two controls more
    auto before = requests();
    use("slots", 0.3);
    EXPECT_TRUE(is_drawn(before));
    before = requests();
    choose("surplus", "power");
    EXPECT_TRUE(is_drawn(before));
    before = requests();
    use("exposure", 0.6);
    EXPECT_EQ(requests(), before) << "the exposure changes the screen alone";
    use("save scene");
    const auto changed = saved_scene(folder)["render"], original = json::parse(scene)["render"];
    for (const auto& [label, part, setting] : sliders)
        EXPECT_TRUE(changed.contains(setting) && changed[setting] != original.value(setting, json())) << setting;
    for (const auto& [setting, word] : std::map<std::string, std::string>{
             {"search", "fixed_radius"}, {"filter", "cone"}, {"bias", "paper"}, {"map", "route"}, {"surplus", "power"}})
        EXPECT_EQ(changed.value(setting, ""), word);
    EXPECT_FALSE(changed.contains("only")) << "files have no such setting";
    EXPECT_NE(changed.value("slots", 0), 0);
    EXPECT_NEAR(changed.value("exposure", -100.0), 2, 0.5);

    // Undone one by one, and redone by the buttons.
    before = requests();
    use("undo");
    use("undo");
    EXPECT_TRUE(is_drawn(before));
    before = requests();
    use("redo");
    use("redo");
    EXPECT_TRUE(is_drawn(before));
    use("fitted grid", 0.05);
    use("fitted exposure", 0.05);
    before = requests();
    use("automatic photons", 0.05);
    EXPECT_TRUE(is_drawn(before));
    use("save scene");
    const auto again = saved_scene(folder, "ball-changed-2.json")["render"];
    EXPECT_EQ(again.value("surplus", ""), "power");
    EXPECT_EQ(again.value("grid", json()), "auto");
    EXPECT_EQ(again.value("photons", json()), "auto");
    EXPECT_EQ(again.value("spp", json()), changed.value("spp", json()));
    EXPECT_FALSE(again.contains("exposure") && again["exposure"].is_number());
    use("save picture");
    EXPECT_TRUE(wait_until([&] { return fs::exists(folder / "ball.png") && fs::exists(folder / "ball.exr"); }));
    program->signal(SIGINT);
    EXPECT_EQ(program->code(), 0) << contents(folder / "program.log");
}

TEST_F(window, the_mouse_moves_camera_and_objects_on_cpu)
{
    ASSERT_NO_FATAL_FAILURE(open_display());
    const auto reference = folder / "reference.pfm";
    {
        process p({PHOTONGRID_PROGRAM, "render", (folder / "ball.json").string(), "--backend", "serial", "-o",
                      reference.string(), "--quiet"},
            folder / "program.log", {});
        ASSERT_EQ(p.code(), 0) << contents(folder / "program.log");
    }
    ASSERT_NO_FATAL_FAILURE(open_window({"--reference", reference.string()}, "cpu"));
    EXPECT_GT(control("error").width, 0) << "no curve of the error to --reference";
    key(XK_o);
    mouse_to(px(0.1), py(0.2));
    auto first = take_screenshot();
    const auto maps_at_first = maps();
    const auto moves = [&](const char* what, const std::function<void()>& act, bool another_map) {
        const auto before = requests();
        const auto maps_before = maps();
        act();
        ASSERT_TRUE(rests(before)) << what;
        EXPECT_GT(difference(take_screenshot(), first), 0.02) << what << " changed nothing";
        EXPECT_EQ(maps() > maps_before, another_map) << what;
        const auto after = requests();
        key(XK_z, true);
        ASSERT_TRUE(rests(after)) << what;
        EXPECT_LT(difference(take_screenshot(), first), 0.002) << what << " is not undone";
    };
    moves(
        "the wheel", [&] { click(px(0.1), py(0.2), 4); }, false);
    moves(
        "the right button", [&] { drag(px(0.1), py(0.2), px(0.2), py(0.3), 3); }, false);
    moves(
        "the middle button", [&] { drag(px(0.1), py(0.2), px(0.2), py(0.3), 2); }, false);
    moves(
        "Shift and a drag",
        [&] {
            hold(XK_Shift_L, true);
            drag(px(0.1), py(0.2), px(0.2), py(0.3));
            hold(XK_Shift_L, false);
        },
        false);
    click(px(0.5), py(0.55)); // selects the ball
    mouse_to(px(0.1), py(0.2));
    first = take_screenshot();
    moves(
        "an object that is dragged", [&] { drag(px(0.5), py(0.55), px(0.6), py(0.5)); }, true);
    moves(
        "an object that is dragged along the floor",
        [&] {
            hold(XK_Shift_L, true);
            drag(px(0.5), py(0.55), px(0.6), py(0.6));
            hold(XK_Shift_L, false);
        },
        true);
    auto before = requests();
    key(XK_y, true);
    ASSERT_TRUE(rests(before));
    EXPECT_GT(difference(take_screenshot(), first), 0.02) << "nothing was redone";
    EXPECT_GT(maps(), maps_at_first);
    program->signal(SIGINT);
    EXPECT_EQ(program->code(), 0) << contents(folder / "program.log");
}

TEST_F(window, the_picture_and_the_mouse_follow_its_size)
{
    ASSERT_NO_FATAL_FAILURE(open_display());
    ASSERT_NO_FATAL_FAILURE(open_window());
    key(XK_o);
    mouse_to(px(0.1), py(0.2));
    const auto first = take_screenshot();
    for (const auto& [new_width, new_height] : {std::pair{970, 540}, {960, 790}, {640, 300}}) {
        SCOPED_TRACE(std::to_string(new_width) + " x " + std::to_string(new_height));
        const auto before = requests();
        resize(new_width, new_height);
        mouse_to(px(0.1), py(0.2));
        const auto s = take_screenshot();
        for (const double part : {0.05, 0.35, 0.65, 0.95}) // the same picture, larger or smaller
            for (const double down : {0.3, 0.6, 0.8})
                EXPECT_NEAR(s.brightness(part - 0.04, part + 0.04, down - 0.04, down + 0.04),
                    first.brightness(part - 0.04, part + 0.04, down - 0.04, down + 0.04), 4)
                    << part << ", " << down;
        EXPECT_EQ(requests(), before) << "the window's size changes the screen alone";
        click(px(lamp_x), py(lamp_y)); // selects the lamp, where it is now
        const auto maps_before = maps();
        drag(px(lamp_x), py(lamp_y), px(0.73), py(lamp_y));
        ASSERT_TRUE(rests(before));
        EXPECT_GT(maps(), maps_before) << "the lamp was not where the picture shows it";
        const auto moved = take_screenshot();
        EXPECT_GT(moved.brightness(0.6, 0.75, 0.66, 0.74), moved.brightness(0.28, 0.4, 0.66, 0.74) + 10);
        const auto after = requests();
        key(XK_z, true);
        ASSERT_TRUE(rests(after));
        key(XK_Escape);
    }
    resize(200, 40); // narrower than the panel
    resize(810, 720);
    mouse_to(px(0.1), py(0.2));
    EXPECT_LT(difference(take_screenshot(), first), 0.001);
    program->signal(SIGINT);
    EXPECT_EQ(program->code(), 0) << contents(folder / "program.log");
}

TEST_F(window, keys_are_what_is_printed_on_them)
{
    // On a German keyboard, y and z have changed places.
    ASSERT_NO_FATAL_FAILURE(open_display());
    {
        process p({"setxkbmap", "de"}, folder / "program.log", {{"DISPLAY", display}});
        ASSERT_EQ(p.code(), 0) << contents(folder / "program.log");
    }
    XCloseDisplay(x);
    x = XOpenDisplay(display.c_str()); // knows the layout from the start
    ASSERT_NE(x, nullptr);
    ASSERT_NO_FATAL_FAILURE(open_window({"--size", "64x48", "--photons", "500"}));
    auto before = requests();
    key(XK_k);
    ASSERT_TRUE(is_drawn(before));
    before = requests();
    key(XK_z, true);
    ASSERT_TRUE(is_drawn(before)) << "Ctrl+Z, where a German keyboard has it, undid nothing";
    before = requests();
    key(XK_y, true);
    ASSERT_TRUE(is_drawn(before)) << "Ctrl+Y redid nothing";

    // A tap counts however short it is, and so does each of many.
    const auto tap = XKeysymToKeycode(x, XK_k);
    for (int i = 0; i < 3; ++i) {
        XTestFakeKeyEvent(x, tap, 1, 0);
        XTestFakeKeyEvent(x, tap, 0, 0);
        XSync(x, 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(3)); // GLFW takes two of one millisecond as one
    }
    pause();
    key(XK_s, true);
    EXPECT_EQ(saved_scene(folder)["render"]["k"], 60 / 16);
    program->signal(SIGINT);
    EXPECT_EQ(program->code(), 0) << contents(folder / "program.log");
}

TEST_F(window, asks_before_changes_are_lost)
{
    ASSERT_NO_FATAL_FAILURE(open_display());
    ASSERT_NO_FATAL_FAILURE(open_window());
    auto before = requests();
    key(XK_k);
    ASSERT_TRUE(is_drawn(before));
    ask_to_close();
    use("stay");
    before = requests();
    key(XK_k);
    ASSERT_TRUE(is_drawn(before)) << "it did not stay, or still asks";
    ask_to_close();
    before = requests();
    key(XK_k);
    EXPECT_EQ(requests(), before) << "a key acts while it asks";
    use("save scene and close");
    EXPECT_EQ(program->code(), 0) << contents(folder / "program.log");
    // Only the value that was changed is other text.
    std::string expected = scene;
    expected.replace(expected.find("\"k\": 60"), 7, "\"k\": 15");
    EXPECT_EQ(contents(folder / "ball-changed.json"), expected);

    fs::remove(folder / "journal");
    ASSERT_NO_FATAL_FAILURE(open_window());
    before = requests();
    key(XK_k);
    ASSERT_TRUE(is_drawn(before));
    ask_to_close();
    use("close without saving");
    EXPECT_EQ(program->code(), 0) << contents(folder / "program.log");
    EXPECT_FALSE(fs::exists(folder / "ball-changed-2.json"));

    fs::remove(folder / "journal");
    ASSERT_NO_FATAL_FAILURE(open_window());
    ask_to_close();
    EXPECT_EQ(program->code(), 0) << "nothing was changed, and it asks";
}

} // namespace
