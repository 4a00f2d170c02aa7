// GLFW and ImGui, open for as long as their objects live.
#pragma once

#include <photongrid/scene/render_settings.hpp>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <memory>
#include <string>

namespace photongrid::viewer {

/// GLFW, open for as long as this lives. What it says last is in `said`.
class glfw {
public:
    /// \throws backend_error when there is no display.
    glfw();
    glfw(const glfw&) = delete;
    glfw& operator=(const glfw&) = delete;
    ~glfw() { glfwTerminate(); }
    static std::string& said()
    {
        static std::string text;
        return text;
    }
};

struct window_closer {
    void operator()(GLFWwindow* w) const { glfwDestroyWindow(w); }
};
using window_handle = std::unique_ptr<GLFWwindow, window_closer>;

/// A window that has room for a picture and, beside it, a panel.
/// \throws backend_error when there is no display, or it gives no OpenGL context.
window_handle open_window(const render_settings& s, float panel_width);

/// ImGui on a window.
class interface {
public:
    /// \throws backend_error when OpenGL has no shaders.
    explicit interface(GLFWwindow* w);
    interface(const interface&) = delete;
    interface& operator=(const interface&) = delete;
    ~interface();
};

/// What the last item does, where the mouse rests on it.
void tip(const char* text);

} // namespace photongrid::viewer
