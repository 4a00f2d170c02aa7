#include "window.hpp"

#include "display.hpp"
#include "picture_pane.hpp"
#include "render_thread.hpp"
#include "settings_panel.hpp"
#include <photongrid/io/image_difference.hpp>
#include <photongrid/io/image_file.hpp>
#include <photongrid/io/scene_writer.hpp>
#include <photongrid/io/tone_map.hpp>

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

    /// A file's name that is not taken: STEM.png, STEM-2.png, …
    std::string free_name(const std::string& stem, const std::string& ending)
    {
        auto name = stem + ending;
        for (int n = 2; std::filesystem::exists(name); ++n)
            name = stem + '-' + std::to_string(n) + ending;
        return name;
    }

    class window {
    public:
        window(const window_options& o, bool (*stop_asked)())
            : options_(o), stop_asked_(stop_asked), handle_(open_window(o.begin.settings, panel_width)),
              interface_(handle_.get()), document_(o.begin), panel_(document_), pane_(document_), journal_(o.journal),
              renderer_(
                  o.renderer, [] { glfwPostEmptyEvent(); },
                  o.journal.empty() ? journal() : [this](const std::string& line) { note(line); })
        {
            if (!o.journal.empty() && !journal_.is_open())
                throw file_error(o.journal + ": cannot be written");
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
                                        "use --backend cpu if the renderer draws on the same GPU");
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
        void note(const std::string& line)
        {
            const std::lock_guard lock(journal_guard_);
            journal_ << line << std::endl; // whole lines, at once: a test reads along
        }

        // --- what is drawn ---
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
            if (!next) {
                if (is_whole() && !fitted_to_whole_)
                    upload();
                return;
            }
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
        /// Whether the picture shown is the last of its request.
        bool is_whole() const { return report_.whole && report_.request == shown_.request; }
        void upload()
        {
            // A fitted exposure follows the picture in steps, so that the screen does not flicker while it converges,
            // and fits the last picture, so that it does not depend on those before.
            const auto set = document_.now().settings.output.exposure;
            fitted_to_whole_ = is_whole();
            if (const double fits = exposure_for(shown_.picture, set);
                set || fitted_to_whole_ || std::abs(fits - exposure_) > 0.25)
                exposure_ = fits;
            pane_.upload(shown_.picture, exposure_);
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
            pane_.draw(shown_.number > 0);
            draw_report(report_, shown_, overlay_);
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

        void draw_panel()
        {
            ImGui::PushItemWidth(170);
            ImGui::TextUnformatted(document_.now().scene.name.c_str());
            if (const auto part = document_.selected())
                ImGui::Text("selected: %s", document_.parts()[*part].name.c_str());
            else
                ImGui::TextDisabled("click selects; drag turns");
            tip("Left button: a click selects; a drag moves the selected object (with Shift, parallel to the floor) "
                "or, elsewhere, turns the camera. Right or middle button, or Shift: pan. Wheel: zoom. A moving camera "
                "keeps the photon map; a change of the scene needs a new one.");
            panel_.draw(exposure_);
            ImGui::Separator();
            draw_buttons();
            draw_curve();
            ImGui::PopItemWidth();
        }

        void draw_buttons()
        {
            if (ImGui::Button("undo"))
                undo();
            tip("Undoes the last change (Ctrl+Z).");
            ImGui::SameLine();
            if (ImGui::Button("redo"))
                redo();
            tip("Redoes what was undone (Ctrl+Y).");
            ImGui::SameLine();
            if (ImGui::Button("save picture"))
                save_picture();
            tip("Saves the current picture as PNG and EXR under new names (p).");
            ImGui::SameLine();
            if (ImGui::Button("save scene"))
                save_scene();
            tip("Saves the scene, with its changes and settings, as a scene file under a new name (Ctrl+S).");
            ImGui::Checkbox("numbers over the picture", &overlay_);
            tip("Shows what runs, for how long, and what is left to do (o).");
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
                "relMSE from picture to picture since your last change, logarithmic: from 100 down to 1e-8.");
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
            panel_.keys(exposure_);
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
            message_ = what.empty() ? "nothing to redo" : "redone: " + what;
        }
        void save_picture()
        {
            if (shown_.number == 0) {
                message_ = "there is no picture yet";
                return;
            }
            try {
                const auto png = free_name(options_.stem, ".png"), exr = png.substr(0, png.size() - 4) + ".exr";
                write_image(png, shown_.picture, exposure_);
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
        window_handle handle_;
        interface interface_;
        document document_;
        settings_panel panel_;
        picture_pane pane_;
        std::mutex journal_guard_;
        std::ofstream journal_;

        frame shown_;
        render_report report_;
        version sent_;
        double exposure_ = 0;                 ///< EV, of the screen
        bool fitted_to_whole_ = false;        ///< exposure_ is fitted to the last picture of its request
        std::vector<float> changes_, errors_; ///< log10, since the last request
        std::string message_;
        bool overlay_ = true;
        render_thread renderer_; ///< last: its thread ends first
    };
} // namespace

void show_window(const window_options& o, bool (*stop_asked)()) { window(o, stop_asked).run(); }

} // namespace photongrid::viewer
