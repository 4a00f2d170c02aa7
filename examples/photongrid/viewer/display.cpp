#include "display.hpp"

#include <photongrid/core/backend.hpp>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>

namespace photongrid::viewer {

glfw::glfw()
{
    glfwSetErrorCallback([](int, const char* text) { said() = text; });
    if (glfwInit() != GLFW_TRUE)
        throw backend_error("view: no window can be opened: " + said()
            + ". Is there a display (DISPLAY or WAYLAND_DISPLAY set; over ssh: -X)? Without one, `photongrid "
              "render --progressive DIR` writes the same pictures to files, and `xvfb-run photongrid view …` "
              "opens the window unseen");
}

window_handle open_window(const render_settings& s, float panel_width)
{
    const float scale
        = std::max(1.0f, std::min(3.0f, 640.0f / static_cast<float>(std::max(s.output.width, s.output.height))));
    const int width = static_cast<int>(scale * static_cast<float>(s.output.width) + panel_width),
              height = std::max(720, static_cast<int>(scale * static_cast<float>(s.output.height)));
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS,
        GLFW_LOSE_CONTEXT_ON_RESET); // so that a loss is said; ignored where it cannot be
    window_handle w(glfwCreateWindow(std::min(width, 1600), std::min(height, 1000), "photongrid", nullptr, nullptr));
    if (!w)
        throw backend_error("view: the display gives no OpenGL context: " + glfw::said()
            + " (Debian: apt install libgl1-mesa-dri libglx-mesa0); `photongrid render --progressive DIR` "
              "needs none");
    glfwMakeContextCurrent(w.get());
    glfwSwapInterval(1);
    return w;
}

interface::interface(GLFWwindow* w)
{
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // nothing of ours is written where nobody asked for it
    ImGui::GetIO().UserData = &controls_;
    ImGui::StyleColorsDark();
    ImGui_ImplGlfw_InitForOpenGL(w, true);
    if (!ImGui_ImplOpenGL3_Init("#version 130"))
        throw backend_error("view: the panel cannot be drawn: this OpenGL has no shaders (Debian: apt install "
                            "libgl1-mesa-dri)");
}

interface::~interface()
{
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void placed(const std::string& label)
{
    const auto low = ImGui::GetItemRectMin(), size = ImGui::GetItemRectSize();
    (*static_cast<control_places*>(ImGui::GetIO().UserData))[label] = {low.x, low.y, size.x, size.y};
}

void tip(const char* label, const char* help)
{
    placed(label);
    if (!ImGui::IsItemHovered())
        return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
    ImGui::TextUnformatted(help);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

} // namespace photongrid::viewer
