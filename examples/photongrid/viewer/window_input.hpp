// What the window's user does that ImGui does not tell: keys as they are printed on the keyboard, and dropped files.
#pragma once

#include <GLFW/glfw3.h>

#include <string>
#include <utility>
#include <vector>

namespace photongrid::viewer {

/// A key that was pressed.
struct key_press {
    static constexpr char escape = 27;

    char key = 0; ///< the letter that the user's layout has there, a to z; or escape
    bool shift = false, control = false;
    bool repeated = false; ///< by holding it
};

/// The keys pressed in a window, in order, however short: a press between two frames counts. And the files that were
/// dropped onto it.
class window_input {
public:
    /// Construct it before the interface, which passes keys on to it.
    explicit window_input(GLFWwindow* w);
    window_input(const window_input&) = delete;
    window_input& operator=(const window_input&) = delete;

    /// Those since the last call.
    std::vector<key_press> take_keys() { return std::exchange(presses_, {}); }
    /// Paths of those since the last call.
    std::vector<std::string> take_dropped() { return std::exchange(dropped_, {}); }

private:
    static window_input& of(GLFWwindow* w) { return *static_cast<window_input*>(glfwGetWindowUserPointer(w)); }

    std::vector<key_press> presses_;
    std::vector<std::string> dropped_;
};

} // namespace photongrid::viewer
