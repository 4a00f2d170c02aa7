// Keys as they are printed on the user's keyboard.
#pragma once

#include <GLFW/glfw3.h>

#include <utility>
#include <vector>

namespace photongrid::viewer {

/// A key that was pressed.
struct key_press {
    char key = 0; ///< the letter that the user's layout has there, a to z; or keyboard::escape
    bool shift = false, control = false;
    bool repeated = false; ///< by holding it
};

/// The keys pressed in a window, in order, however short: a press between two frames counts.
class keyboard {
public:
    static constexpr char escape = 27;

    /// Construct it before the interface, which passes keys on to it.
    explicit keyboard(GLFWwindow* w);
    keyboard(const keyboard&) = delete;
    keyboard& operator=(const keyboard&) = delete;

    /// Those since the last call.
    std::vector<key_press> take() { return std::exchange(presses_, {}); }

private:
    std::vector<key_press> presses_;
};

} // namespace photongrid::viewer
