#include "window.hpp"

#include "render_thread.hpp"
#include <photongrid/io/image_difference.hpp>
#include <photongrid/io/image_file.hpp>
#include <photongrid/io/scene_writer.hpp>
#include <photongrid/io/tone_map.hpp>
#include <photongrid/scene/setting_table.hpp>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace photongrid::viewer {

namespace {
    constexpr float panel_width = 330;
    constexpr GLenum context_lost = 0x0507; // GL_CONTEXT_LOST

    /// GLFW, initialised for the lifetime of this object. Its last message is in `said`.
    class glfw {
    public:
        glfw()
        {
            glfwSetErrorCallback([](int, const char* text) { said() = text; });
            if (glfwInit() != GLFW_TRUE)
                throw backend_error("view: no window can be opened: " + said()
                    + ". Is there a display (DISPLAY or WAYLAND_DISPLAY set; over ssh: -X)? Without one, `photongrid "
                      "render --progressive DIR` writes the same pictures to files, and `xvfb-run photongrid view …` "
                      "opens the window unseen");
        }
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

    /// ImGui on a window.
    class interface {
    public:
        explicit interface(GLFWwindow* w)
        {
            IMGUI_CHECKVERSION();
            ImGui::CreateContext();
            ImGui::GetIO().IniFilename = nullptr; // write no settings file
            ImGui::StyleColorsDark();
            ImGui_ImplGlfw_InitForOpenGL(w, true);
            if (!ImGui_ImplOpenGL3_Init("#version 130"))
                throw backend_error("view: the panel cannot be drawn: this OpenGL has no shaders (Debian: apt install "
                                    "libgl1-mesa-dri)");
        }
        interface(const interface&) = delete;
        interface& operator=(const interface&) = delete;
        ~interface()
        {
            ImGui_ImplOpenGL3_Shutdown();
            ImGui_ImplGlfw_Shutdown();
            ImGui::DestroyContext();
        }
    };

    /// Shows a description of the last item while the mouse rests on it.
    void tip(const char* text)
    {
        if (!ImGui::IsItemHovered())
            return;
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
        ImGui::TextUnformatted(text);
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }

    /// A file name that is not in use: STEM.png, STEM-2.png, …
    std::string free_name(const std::string& stem, const std::string& ending)
    {
        auto name = stem + ending;
        for (int n = 2; std::filesystem::exists(name); ++n)
            name = stem + '-' + std::to_string(n) + ending;
        return name;
    }

    /// A rectangle of the picture's pixels.
    struct frame_box {
        double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
    };

    /// The outline of a part of the scene in the picture; empty if some of it is behind the camera.
    std::optional<frame_box> box_of(const scene& s, const scene_part& part, double width, double height)
    {
        bounds b;
        for_each_item(s, part, [&](const auto& item, auto kind) { kind.add_bounds(b, item); });
        const auto& c = s.camera;
        const auto [forward, right, up] = photongrid::detail::camera_axes(c);
        const double half_height = std::tan(glm::radians(c.vertical_fov) / 2);
        frame_box f;
        for (int corner = 0; corner < 8; ++corner) {
            const dvec3 to = dvec3(corner & 1 ? b.high.x : b.low.x, corner & 2 ? b.high.y : b.low.y,
                                 corner & 4 ? b.high.z : b.low.z)
                - c.position;
            const double depth = glm::dot(to, forward);
            if (depth <= 0)
                return std::nullopt;
            const double x = 0.5 * width + 0.5 * height * glm::dot(to, right) / (depth * half_height),
                         y = 0.5 * height - 0.5 * height * glm::dot(to, up) / (depth * half_height);
            f.left = std::min(f.left, x), f.right = std::max(f.right, x), f.top = std::min(f.top, y),
            f.bottom = std::max(f.bottom, y);
        }
        return f;
    }

    class window {
    public:
        window(const window_options& o, bool (*stop_asked)())
            : options_(o), stop_asked_(stop_asked), handle_(open(o.begin.settings)), interface_(handle_.get()),
              document_(o.begin), journal_(o.journal),
              renderer_(
                  o.renderer, [] { glfwPostEmptyEvent(); },
                  o.journal.empty() ? journal() : [this](const std::string& line) { note(line); })
        {
            if (!o.journal.empty() && !journal_.is_open())
                throw file_error(o.journal + ": cannot be written");
            glGenTextures(1, &texture_);
            glBindTexture(GL_TEXTURE_2D, texture_);
            for (const auto& [name, value] :
                {std::pair{GL_TEXTURE_MIN_FILTER, GL_LINEAR}, {GL_TEXTURE_MAG_FILTER, GL_LINEAR},
                    {GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE}, {GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE}})
                glTexParameteri(GL_TEXTURE_2D, static_cast<GLenum>(name), value);
            glfwSetWindowUserPointer(handle_.get(), this);
            send(false);
        }
        window(const window&) = delete;
        window& operator=(const window&) = delete;

        void run()
        {
            std::uint64_t turns = 0, slow_turns = 0;
            double slowest_ms = 0;
            while (glfwWindowShouldClose(handle_.get()) == GLFW_FALSE && !stop_asked_()) {
                // Events and new pictures wake it at once.
                glfwWaitEventsTimeout(report_.progress.stage == "finished" ? 0.5 : 0.1);
                const double begin = glfwGetTime();
                take_news();
                draw();
                if (glGetError() == context_lost)
                    throw backend_error("view: the window's OpenGL context was lost (driver reset); open it again, or "
                                        "take --backend cpu if the GPU is the renderer's too");
                ++turns;
                const double ms = 1000 * (glfwGetTime() - begin);
                slowest_ms = std::max(slowest_ms, ms);
                slow_turns += ms > 1000.0 / 30 ? 1u : 0u;
            }
            if (journal_.is_open())
                note("{\"event\": \"closed\", \"turns\": " + std::to_string(turns) + ", \"turns_above_33_ms\": "
                    + std::to_string(slow_turns) + ", \"slowest_turn_ms\": " + std::to_string(slowest_ms) + "}");
        }

    private:
        static std::unique_ptr<GLFWwindow, window_closer> open(const render_settings& s)
        {
            const float scale = std::max(
                1.0f, std::min(3.0f, 640.0f / static_cast<float>(std::max(s.output.width, s.output.height))));
            const int width = static_cast<int>(scale * static_cast<float>(s.output.width) + panel_width),
                      height = std::max(720, static_cast<int>(scale * static_cast<float>(s.output.height)));
            glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS,
                GLFW_LOSE_CONTEXT_ON_RESET); // so that a loss is reported; ignored if not supported
            std::unique_ptr<GLFWwindow, window_closer> w(
                glfwCreateWindow(std::min(width, 1600), std::min(height, 1000), "photongrid", nullptr, nullptr));
            if (!w)
                throw backend_error("view: the display gives no OpenGL context: " + glfw::said()
                    + " (Debian: apt install libgl1-mesa-dri libglx-mesa0); `photongrid render --progressive DIR` "
                      "needs none");
            glfwMakeContextCurrent(w.get());
            glfwSwapInterval(1);
            return w;
        }

        void note(const std::string& line)
        {
            const std::lock_guard lock(journal_guard_);
            journal_ << line << std::endl; // whole lines, flushed: a test reads them as they come
        }

        // --- requests and pictures ---
        void send(bool moving)
        {
            sent_ = document_.now();
            renderer_.show(sent_, moving);
        }
        void send_changes(bool moving)
        {
            auto now = document_.now();
            const bool other_exposure = now.settings.output.exposure != sent_.settings.output.exposure;
            if (other_exposure)
                upload();
            auto before = sent_;
            before.settings.output.exposure = now.settings.output.exposure; // changes the screen, not the picture
            if (now == before)
                sent_ = now;
            else
                send(moving);
        }

        void take_news()
        {
            report_ = renderer_.report();
            auto next = renderer_.newer_than(shown_.number);
            if (!next)
                return;
            if (next->request != shown_.request) {
                changes_.clear();
                errors_.clear();
            }
            shown_ = std::move(*next);
            if (shown_.change > 0)
                changes_.push_back(static_cast<float>(std::log10(shown_.change)));
            if (const auto& r = options_.reference;
                r && r->width == shown_.picture.width && r->height == shown_.picture.height)
                errors_.push_back(
                    static_cast<float>(std::log10(std::max(1e-12, compare_images(shown_.picture, *r).relmse))));
            upload();
        }

        void upload()
        {
            const auto& p = shown_.picture;
            if (p.pixels.empty())
                return;
            const tone_map to_screen(document_.now().settings.output.exposure);
            bytes_.clear();
            for (const auto& pixel : p.pixels)
                for (int c = 0; c < 3; ++c)
                    bytes_.push_back(to_screen(pixel[c]));
            glBindTexture(GL_TEXTURE_2D, texture_);
            glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
            glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, static_cast<GLsizei>(p.width), static_cast<GLsizei>(p.height), 0,
                GL_RGB, GL_UNSIGNED_BYTE, bytes_.data());
        }

        // --- the screen ---
        void draw()
        {
            ImGui_ImplOpenGL3_NewFrame();
            ImGui_ImplGlfw_NewFrame();
            ImGui::NewFrame();
            const auto size = ImGui::GetIO().DisplaySize;
            constexpr auto fixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove
                | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({std::max(1.0f, size.x - panel_width), size.y});
            ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
            ImGui::Begin(
                "picture", nullptr, fixed | ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoBackground);
            ImGui::PopStyleVar();
            draw_picture();
            ImGui::End();
            ImGui::SetNextWindowPos({size.x - panel_width, 0});
            ImGui::SetNextWindowSize({panel_width, size.y});
            ImGui::Begin("settings", nullptr, fixed & ~ImGuiWindowFlags_NoScrollbar);
            draw_panel();
            ImGui::End();
            if (!ImGui::GetIO().WantTextInput)
                keys();
            send_changes(ImGui::IsAnyMouseDown());

            ImGui::Render();
            int width = 0, height = 0;
            glfwGetFramebufferSize(handle_.get(), &width, &height);
            glViewport(0, 0, width, height);
            glClearColor(0.08f, 0.08f, 0.08f, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
            glfwSwapBuffers(handle_.get());
        }

        void draw_picture()
        {
            const auto& s = document_.now().settings;
            const auto room = ImGui::GetContentRegionAvail();
            const float scale = std::max(1e-3f,
                std::min(room.x / static_cast<float>(s.output.width), room.y / static_cast<float>(s.output.height)));
            const ImVec2 size(scale * static_cast<float>(s.output.width), scale * static_cast<float>(s.output.height));
            const ImVec2 corner(std::max(0.0f, 0.5f * (room.x - size.x)), std::max(0.0f, 0.5f * (room.y - size.y)));
            if (shown_.number > 0)
                ImGui::GetWindowDrawList()->AddImage(
                    reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_)), corner,
                    {corner.x + size.x, corner.y + size.y});
            ImGui::SetCursorPos(corner);
            ImGui::InvisibleButton("mouse", size,
                ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle
                    | ImGuiButtonFlags_MouseButtonRight);
            mouse(corner, size);
            if (const auto part = document_.selected())
                if (const auto box = box_of(document_.now().scene, document_.parts()[*part],
                        static_cast<double>(size.x), static_cast<double>(size.y)))
                    ImGui::GetWindowDrawList()->AddRect(
                        {corner.x + static_cast<float>(box->left) - 3, corner.y + static_cast<float>(box->top) - 3},
                        {corner.x + static_cast<float>(box->right) + 3, corner.y + static_cast<float>(box->bottom) + 3},
                        IM_COL32(255, 200, 60, 200), 4, 0, 1.5f);
            draw_overlay();
        }

        void draw_overlay()
        {
            const auto& r = report_;
            char text[512];
            const auto& st = r.stats;
            std::snprintf(text, sizeof text,
                "%s on %s\n%s %.0f %%  pictures %llu  after %.0f ms\nphotons %u  maps %llu  passes %llu  unfinished "
                "%llu\ntrace %.0f  build %.0f  rays %.0f  estimate %.0f ms",
                r.backend.c_str(), r.device.substr(0, 40).c_str(), std::string(r.progress.stage).c_str(),
                100 * r.progress.fraction, static_cast<unsigned long long>(shown_.number), shown_.ms,
                r.progress.photons, static_cast<unsigned long long>(r.maps), static_cast<unsigned long long>(r.passes),
                static_cast<unsigned long long>(r.progress.unfinished), st.trace_photons.ms, st.build_map.ms,
                st.trace_rays.ms, st.radiance_estimate.ms);
            auto* list = ImGui::GetWindowDrawList();
            if (overlay_) {
                list->AddText({9, 9}, IM_COL32(0, 0, 0, 255), text);
                list->AddText({8, 8}, IM_COL32(255, 255, 255, 230), text);
            }
            if (!r.error.empty())
                list->AddText(nullptr, 0, {8, 80}, IM_COL32(255, 120, 90, 255), ("not drawn: " + r.error).c_str(),
                    nullptr, std::max(100.0f, ImGui::GetIO().DisplaySize.x - panel_width - 16));
        }

        // --- the mouse ---
        void mouse(const ImVec2& corner, const ImVec2& size)
        {
            const auto& io = ImGui::GetIO();
            const double width = static_cast<double>(size.x), height = static_cast<double>(size.y);
            const double x = static_cast<double>(io.MousePos.x - corner.x),
                         y = static_cast<double>(io.MousePos.y - corner.y);
            if (ImGui::IsItemHovered() && io.MouseWheel != 0.0f) {
                document_.begin("zoom");
                document_.zoom(std::pow(1.1, static_cast<double>(io.MouseWheel)));
            }
            if (ImGui::IsItemActivated()) {
                pressed_ = pick(document_.now().scene, document_.parts(), width, height, x, y);
                moved_ = false;
                moves_part_
                    = ImGui::IsMouseDown(ImGuiMouseButton_Left) && pressed_ && document_.selected() == pressed_->part;
            }
            if (ImGui::IsItemActive()) {
                const bool left = ImGui::IsMouseDown(ImGuiMouseButton_Left);
                if (!moved_
                    && ImGui::IsMouseDragging(left                        ? ImGuiMouseButton_Left
                            : ImGui::IsMouseDown(ImGuiMouseButton_Middle) ? ImGuiMouseButton_Middle
                                                                          : ImGuiMouseButton_Right,
                        3.0f)) {
                    moved_ = true;
                    document_.begin(moves_part_    ? "move of " + document_.parts()[pressed_->part].name
                            : left && !io.KeyShift ? "turn"
                                                   : "pan");
                }
                if (!moved_)
                    return;
                if (moves_part_)
                    drag(sight_line_at(document_.now().scene.camera, width, height, x, y), io.KeyShift);
                else if (left && !io.KeyShift)
                    document_.orbit(180 * static_cast<double>(io.MouseDelta.x) / width,
                        180 * static_cast<double>(io.MouseDelta.y) / height);
                else
                    document_.pan(
                        -static_cast<double>(io.MouseDelta.x) / height, static_cast<double>(io.MouseDelta.y) / height);
            }
            if (ImGui::IsItemDeactivated() && !moved_ && ImGui::IsMouseReleased(ImGuiMouseButton_Left))
                document_.select(pressed_ ? std::optional(pressed_->part) : std::nullopt);
        }

        void drag(const sight_line& line, bool level)
        {
            const auto to = on_plane(document_.now().scene.camera, line, pressed_->position, level);
            if (!to)
                return;
            move(document_.edit().scene, document_.parts()[pressed_->part], *to - pressed_->position);
            pressed_->position = *to;
        }

        // --- settings ---
        /// After an item that changes settings: one step of undo for as long as it is held.
        bool begun(const char* name)
        {
            if (ImGui::IsItemActivated())
                held_ = document_.now();
            if (!ImGui::IsItemEdited())
                return false;
            if (held_) {
                document_.begin(name);
                held_.reset();
            }
            return true;
        }

        // A control for a row of the table of settings. Its label may be more than the setting's name.

        /// A word for each value.
        template <class Row>
        void choice(const Row& row, const char* label, const char* text)
        {
            const auto value = row.of(document_.now().settings);
            if (ImGui::BeginCombo(label, row.values.word_for(value))) {
                for (const auto& n : row.values.values)
                    if (ImGui::Selectable(n.name, n.value == value))
                        change(label, [&](render_settings& s) { row.of(s) = n.value; });
                ImGui::EndCombo();
            }
            tip(text);
        }

        /// A whole number, by a slider whose steps are even in its logarithm.
        template <class Row>
        void number(const Row& row, const char* label, int low, int high, const char* text)
        {
            int value = static_cast<int>(row.of(document_.now().settings));
            const bool edited = ImGui::SliderInt(
                label, &value, low, high, "%d", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
            if (begun(label) && edited)
                row.of(document_.edit().settings) = static_cast<std::uint32_t>(value);
            tip(text);
        }

        template <class Row>
        void measure(const Row& row, const char* label, float low, float high, const char* format, bool logarithmic,
            const char* text)
        {
            float value = static_cast<float>(row.of(document_.now().settings));
            const bool edited = ImGui::SliderFloat(label, &value, low, high, format,
                (logarithmic ? ImGuiSliderFlags_Logarithmic : 0) | ImGuiSliderFlags_AlwaysClamp);
            if (begun(label) && edited)
                row.of(document_.edit().settings) = static_cast<double>(value);
            tip(text);
        }

        template <class Change>
        void change(const std::string& name, Change apply)
        {
            document_.begin(name);
            apply(document_.edit().settings);
        }

        void draw_panel()
        {
            ImGui::PushItemWidth(170);
            ImGui::TextUnformatted(document_.now().scene.name.c_str());
            if (const auto part = document_.selected())
                ImGui::Text("selected: %s", document_.parts()[*part].name.c_str());
            else
                ImGui::TextDisabled("click selects; drag turns");
            tip("Left button: click selects, a drag moves what is selected (with Shift level with the floor), "
                "elsewhere it turns the camera. Right or middle button, or Shift: pans. Wheel: zooms. A moving camera "
                "keeps the photon map; "
                "what moves in the scene needs a new one.");
            ImGui::Separator();
            draw_backend();
            const auto& s = document_.now().settings;
            number(setting_table::photons, "photons", 256, 4000000,
                "Photons stored (N, n). Speed: tracing and sorting them takes proportionally longer. Error: noise "
                "falls with the square root.");
            number(setting_table::k, "k", 1, 4000,
                "Photons in an estimate (K, k). Speed: more take longer. Error: more are smoother, and blur shadows "
                "and caustics more.");
            measure(setting_table::max_radius, "radius, m", 1e-3f, 10.0f, "%.4f", true,
                "Largest search radius (R, r). Speed: dark places search this far. Error: where fewer than k photons "
                "lie within it, estimates are noisier instead of more blurred.");
            choice(setting_table::search, "search",
                "Which photons (s): the k nearest; at least k, as in the paper, which uses more photons and is a "
                "little too bright; or all within the radius.");
            choice(setting_table::filter, "filter",
                "Weight by distance (w). Speed: the same. Error: constant is the least noisy and shows discs; "
                "silverman the smoothest.");
            choice(setting_table::bias, "bias",
                "The photon that sets the radius: paper counts it, k / (k - 1) too bright; unbiased leaves it out.");
            draw_grid();
            choice(setting_table::map, "map",
                "How the photon map is built (m). sort is exact; route takes fewer passes and, where cells overflow, "
                "is approximate.");
            if (s.map.builder == map_builder::route)
                number(setting_table::slots, "slots", 1, 16,
                    "Cells have slots x slots slots. More lose fewer photons and take more memory.");
            ImGui::Separator();
            number(setting_table::spp, "eye rays", 1, 64,
                "Eye rays per pixel. Speed: proportional. Error: smooth edges, less noise of glass and lamps.");
            number(setting_table::passes, "passes", 1, 1024,
                "The picture is the mean of this many passes, each with photons and rays of its own. Speed: "
                "proportional. "
                "Error: "
                "noise and blotches fade as they come.");
            number(setting_table::light_samples, "light samples", 1, 256,
                "Shadow rays per lamp and eye ray. Speed: proportional for direct light. Error: smoother "
                "half-shadows.");
            choice(setting_table::only, "light",
                "Which part of the light is shown. Caustics or indirect light alone need a map of their own.");
            bool side = s.estimate.leaks.side;
            if (ImGui::Checkbox("side", &side))
                change("side", [&](render_settings& r) { r.estimate.leaks.side = side; });
            tip("Reject photons that came from behind a surface. Speed: hardly any. Error: no light leaks through "
                "walls.");
            measure(setting_table::exposure, "exposure, EV", -10, 10, "%+.1f", false,
                "Brightness of the screen and of saved PNGs (E, e). Needs no new drawing.");
            ImGui::Separator();
            draw_buttons();
            draw_curve();
            ImGui::PopItemWidth();
        }

        void draw_backend()
        {
            const auto& now = document_.now().backend;
            if (ImGui::BeginCombo("backend", now.c_str())) {
                for (const auto* name : {"serial", "cpu", "gl", "gl-osmesa", "vulkan"})
                    if (ImGui::Selectable(name, now == name)) {
                        document_.begin("backend");
                        document_.edit().backend = name;
                    }
                ImGui::EndCombo();
            }
            tip("The backend (b). The same photons give the same picture on all; speed differs. cpu is the fastest "
                "without a GPU.");
        }

        /// The grid that is not fitted: the scene's, or a default if it names none.
        glm::uvec3 cells_of_scene() const
        {
            return options_.begin.settings.map.grid == glm::uvec3(0) ? glm::uvec3(32)
                                                                     : options_.begin.settings.map.grid;
        }
        void draw_grid()
        {
            auto cells = glm::ivec3(document_.now().settings.map.grid);
            bool fitted = cells == glm::ivec3(0);
            if (ImGui::Checkbox("fitted grid", &fitted))
                change("grid", [&](render_settings& r) { r.map.grid = fitted ? glm::uvec3(0) : cells_of_scene(); });
            tip("Cells of the photon map fitted to photons and k (g). Speed: a grid that is too coarse or too fine "
                "searches longer. Error: none for the k nearest; `at_least_k` depends on its cells.");
            if (!fitted) {
                const bool edited = ImGui::SliderInt3(
                    "grid", &cells.x, 1, 256, "%d", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
                if (begun("grid") && edited)
                    document_.edit().settings.map.grid = glm::uvec3(cells);
                tip("Cells along x, y and z.");
            }
        }

        void draw_buttons()
        {
            if (ImGui::Button("undo"))
                undo();
            tip("Undoes the last change (Ctrl+Z).");
            ImGui::SameLine();
            if (ImGui::Button("redo"))
                redo();
            tip("Redoes it (Ctrl+Y).");
            ImGui::SameLine();
            if (ImGui::Button("save picture"))
                save_picture();
            tip("Writes the current picture, PNG and EXR, under an unused name (p).");
            ImGui::SameLine();
            if (ImGui::Button("save scene"))
                save_scene();
            tip("Writes the scene with its changes and settings as a scene file, under an unused name (Ctrl+S).");
            ImGui::Checkbox("numbers over the picture", &overlay_);
            tip("The current stage, its time, and the work left (o).");
            if (!message_.empty())
                ImGui::TextWrapped("%s", message_.c_str());
        }

        void draw_curve()
        {
            const auto plot = [](const char* label, const std::vector<float>& values, const char* text) {
                char last[48] = "";
                if (!values.empty())
                    std::snprintf(last, sizeof last, "%.2g", std::pow(10.0, static_cast<double>(values.back())));
                ImGui::PlotLines(label, values.data(), static_cast<int>(values.size()), 0, last, -8, 2, {170, 60});
                tip(text);
            };
            plot("change", changes_,
                "relMSE from picture to picture since the last change of yours, logarithmic: from 100 down to 1e-8.");
            if (options_.reference)
                plot("error", errors_, "relMSE to the reference, logarithmic: from 100 down to 1e-8.");
        }

        // --- keys ---
        void keys()
        {
            const auto& io = ImGui::GetIO();
            const auto pressed = [](int key) { return ImGui::IsKeyPressed(key); };
            if (io.KeyCtrl) {
                if (pressed(GLFW_KEY_Z))
                    io.KeyShift ? redo() : undo();
                if (pressed(GLFW_KEY_Y))
                    redo();
                if (pressed(GLFW_KEY_S))
                    save_scene();
                return;
            }
            const bool up = io.KeyShift;
            const auto doubled = [&](int key, const auto& row) {
                if (pressed(key))
                    change(row.name, [&](render_settings& s) {
                        auto& value = row.of(s);
                        value = std::clamp(up ? value * 2 : value / 2, row.values.least, row.values.most / 2);
                    });
            };
            const auto next = [&](int key, const auto& row) {
                if (pressed(key))
                    change(row.name, [&](render_settings& s) {
                        const auto& all = row.values.values;
                        std::size_t i = 0;
                        while (all[i].value != row.of(s))
                            ++i;
                        row.of(s) = all[(i + 1) % std::size(all)].value;
                    });
            };
            doubled(GLFW_KEY_K, setting_table::k);
            doubled(GLFW_KEY_N, setting_table::photons);
            next(GLFW_KEY_M, setting_table::map);
            next(GLFW_KEY_S, setting_table::search);
            next(GLFW_KEY_W, setting_table::filter);
            if (pressed(GLFW_KEY_R))
                change("radius", [&](render_settings& s) { s.estimate.max_radius *= up ? 1.25 : 0.8; });
            if (pressed(GLFW_KEY_E))
                change("exposure", [&](render_settings& s) {
                    s.output.exposure = std::clamp(s.output.exposure + (up ? 0.5 : -0.5), -64.0, 64.0);
                });
            if (pressed(GLFW_KEY_G))
                change("grid", [&](render_settings& s) {
                    s.map.grid = s.map.grid == glm::uvec3(0) ? cells_of_scene() : glm::uvec3(0);
                });
            if (pressed(GLFW_KEY_B)) {
                document_.begin("backend");
                auto& b = document_.edit().backend;
                b = b == "serial" ? "cpu" : b == "cpu" ? "gl" : b == "gl" ? "vulkan" : "serial";
            }
            if (pressed(GLFW_KEY_P))
                save_picture();
            if (pressed(GLFW_KEY_O))
                overlay_ = !overlay_;
            if (pressed(GLFW_KEY_ESCAPE))
                document_.select(std::nullopt);
        }

        void undo()
        {
            const auto what = document_.undo();
            message_ = what.empty() ? "nothing to undo" : "undone: " + what;
        }
        void redo()
        {
            const auto what = document_.redo();
            message_ = what.empty() ? "nothing to redo" : "done again: " + what;
        }
        void save_picture()
        {
            if (shown_.number == 0) {
                message_ = "there is no picture yet";
                return;
            }
            try {
                const auto png = free_name(options_.stem, ".png"), exr = png.substr(0, png.size() - 4) + ".exr";
                write_image(png, shown_.picture, document_.now().settings.output.exposure);
                write_image(exr, shown_.picture);
                message_ = "saved " + png + " and " + exr;
            } catch (const file_error& e) {
                message_ = e.what();
            }
        }
        void save_scene()
        {
            try {
                const auto name = free_name(options_.stem + "-changed", ".json");
                write_file(name, scene_text(document_.now().scene, document_.now().settings));
                message_ = "saved " + name;
            } catch (const file_error& e) {
                message_ = e.what();
            }
        }

        window_options options_;
        bool (*stop_asked_)();
        glfw glfw_;
        std::unique_ptr<GLFWwindow, window_closer> handle_;
        interface interface_;
        document document_;
        std::mutex journal_guard_;
        std::ofstream journal_;

        GLuint texture_ = 0;
        std::vector<unsigned char> bytes_;
        frame shown_;
        render_report report_;
        version sent_;
        std::vector<float> changes_, errors_; ///< log10, since the last request
        std::string message_;
        bool overlay_ = true;
        std::optional<grip> pressed_; ///< where a button went down
        bool moved_ = false, moves_part_ = false;
        std::optional<version> held_; ///< before the item that is held was edited
        render_thread renderer_;      ///< last: its thread ends first
    };
} // namespace

void show_window(const window_options& o, bool (*stop_asked)()) { window(o, stop_asked).run(); }

} // namespace photongrid::viewer
