#include "window_input.hpp"

namespace photongrid::viewer {

namespace {
    /// The letter on a key, or 0. GLFW's key is its place on a US keyboard; that counts where the layout has no Latin
    /// letters.
    char letter_of(int key, int scancode)
    {
        if (key == GLFW_KEY_ESCAPE)
            return key_press::escape;
        const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
        if (const char* name = glfwGetKeyName(key, scancode)) {
            if (is_letter(name[0]) && name[1] == 0)
                return name[0];
            if (static_cast<unsigned char>(name[0]) < 0x80) // another ASCII character
                return 0;
        }
        return key >= GLFW_KEY_A && key <= GLFW_KEY_Z ? static_cast<char>('a' + (key - GLFW_KEY_A)) : '\0';
    }
} // namespace

window_input::window_input(GLFWwindow* w)
{
    glfwSetWindowUserPointer(w, this);
    glfwSetKeyCallback(w, [](GLFWwindow* from, int key, int scancode, int action, int held) {
        if (action == GLFW_RELEASE)
            return;
        if (const char c = letter_of(key, scancode))
            of(from).presses_.push_back({.key = c,
                .shift = (held & GLFW_MOD_SHIFT) != 0,
                .control = (held & GLFW_MOD_CONTROL) != 0,
                .repeated = action == GLFW_REPEAT});
    });
    glfwSetDropCallback(w, [](GLFWwindow* on, int count, const char** paths) {
        auto& all = of(on).dropped_;
        all.insert(all.end(), paths, paths + count);
    });
}

} // namespace photongrid::viewer
