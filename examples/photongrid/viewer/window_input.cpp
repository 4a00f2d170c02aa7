#include "keyboard.hpp"

namespace photongrid::viewer {

namespace {
    /// The letter on a key, or 0. GLFW's key is its place on a US keyboard; that counts where the layout has no Latin
    /// letters.
    char letter_of(int key, int scancode)
    {
        if (key == GLFW_KEY_ESCAPE)
            return keyboard::escape;
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

keyboard::keyboard(GLFWwindow* w)
{
    glfwSetWindowUserPointer(w, this);
    glfwSetKeyCallback(w, [](GLFWwindow* from, int key, int scancode, int action, int held) {
        if (action == GLFW_RELEASE)
            return;
        if (const char c = letter_of(key, scancode))
            static_cast<keyboard*>(glfwGetWindowUserPointer(from))
                ->presses_.push_back({.key = c,
                    .shift = (held & GLFW_MOD_SHIFT) != 0,
                    .control = (held & GLFW_MOD_CONTROL) != 0,
                    .repeated = action == GLFW_REPEAT});
    });
}

} // namespace photongrid::viewer
