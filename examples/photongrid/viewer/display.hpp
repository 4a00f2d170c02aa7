// GLFW and ImGui, open for as long as their objects live.
#pragma once

#include <photongrid/scene/render_settings.hpp>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <map>
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

/// Where a control is in the window, in pixels from its upper left corner.
struct control_place {
    float x = 0, y = 0, width = 0, height = 0;
    bool operator==(const control_place&) const = default;
};
/// By label.
using control_places = std::map<std::string, control_place>;

/// ImGui on a window.
class interface {
public:
    /// \throws backend_error when OpenGL has no shaders.
    explicit interface(GLFWwindow* w);
    interface(const interface&) = delete;
    interface& operator=(const interface&) = delete;
    ~interface();

    /// Of the controls drawn so far, for tests that use them as a person does (--journal).
    const control_places& controls() const { return controls_; }

private:
    control_places controls_;
};

/// After a control: notes its place.
void placed(const std::string& label);
/// After a control: notes its place, and says what it does where the mouse rests on it.
void tip(const char* label, const char* help);

} // namespace photongrid::viewer
