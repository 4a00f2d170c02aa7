// The window: its loop, its panel and what keys do. The file is long because it is one class, of small functions that
// pass on what the user does.
#include "window.hpp"

#include "display.hpp"
#include "keyboard.hpp"
#include "newest_picture.hpp"
#include "picture_pane.hpp"
#include "saved_files.hpp"
#include "settings_panel.hpp"
#include <photongrid/backends/any/module.hpp>
#include <photongrid/io/files.hpp>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <fstream>
#include <utility>

PHOTONGRID_MODULE

namespace photongrid::viewer {

namespace {
    constexpr float panel_width = 330;
    constexpr GLenum context_lost = 0x0507; // GL_CONTEXT_LOST

    class window {
    public:
        window(const window_options& o, bool (*stop_asked)())
            : options_(o), stop_asked_(stop_asked), handle_(open_window(o.begin.settings, panel_width)),
              keyboard_(handle_.get()), interface_(handle_.get()), document_(o.begin), panel_(document_),
              pane_(document_), picture_(renderer_, pane_, o.reference), saved_(o), journal_(o.journal),
              renderer_(
                  o.make, o.renderer, [] { glfwPostEmptyEvent(); },
                  o.journal.empty() ? journal() : [this](const std::string& line) { note(line); })
        {
            if (!o.journal.empty() && !journal_.is_open())
                throw file_error(o.journal + ": cannot be written");
            send(false);
        }
        window(const window&) = delete;
        window& operator=(const window&) = delete;

        void run()
        {
            std::uint64_t turns = 0, slow_turns = 0;
            double slowest_ms = 0;
            bool settles = true;
            while (!closes() && !stop_asked_()) {
                // Events and new pictures wake it at once. Draw one more frame: ImGui lays out new widgets over two.
                const double asleep = glfwGetTime(),
                             longest = settles                       ? 0.02
                    : picture_.report().progress.stage == "finished" ? 0.5
                                                                     : 0.1;
                glfwWaitEventsTimeout(longest);
                const double begin = glfwGetTime();
                settles = begin - asleep < longest;
                picture_.take_news(document_.now().settings.output.exposure);
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

        /// Whether the window closes. If that would lose changes, its user is asked first.
        bool closes()
        {
            if (glfwWindowShouldClose(handle_.get()) == GLFW_FALSE)
                return false;
            if (closes_anyway_ || !saved_.lacks(document_.now()))
                return true;
            glfwSetWindowShouldClose(handle_.get(), GLFW_FALSE);
            asks_to_close_ = true;
            glfwPostEmptyEvent();
            return false;
        }
        void close_anyway()
        {
            closes_anyway_ = true;
            glfwSetWindowShouldClose(handle_.get(), GLFW_TRUE);
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
            if (now.settings.output.exposure != sent_.settings.output.exposure)
                picture_.show(now.settings.output.exposure);
            auto before = sent_;
            before.settings.output.exposure = now.settings.output.exposure; // changes the screen, not the picture
            if (now == before)
                sent_ = now;
            else
                send(moving);
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
            pane_.draw(picture_.shown().number > 0);
            draw_report(picture_.report(), picture_.shown(), overlay_);
            ImGui::End();
            ImGui::SetNextWindowPos({size.x - panel_width, 0});
            ImGui::SetNextWindowSize({panel_width, size.y});
            ImGui::Begin("settings", nullptr, fixed & ~ImGuiWindowFlags_NoScrollbar);
            draw_panel();
            ImGui::End();
            keys(draw_question());
            note_controls();
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
            tip("click selects",
                "Left button: a click selects; a drag moves the selected object (with Shift, parallel to the floor) "
                "or, elsewhere, turns the camera. Right or middle button, or Shift: pan. Wheel: zoom. A moving camera "
                "keeps the photon map; a change of the scene needs a new one.");
            panel_.draw(picture_.exposure());
            ImGui::Separator();
            draw_buttons();
            picture_.draw_curves();
            ImGui::PopItemWidth();
        }

        void draw_buttons()
        {
            if (ImGui::Button("undo"))
                undo();
            tip("undo", "Undoes the last change (Ctrl+Z).");
            ImGui::SameLine();
            if (ImGui::Button("redo"))
                redo();
            tip("redo", "Redoes what was undone (Ctrl+Y).");
            ImGui::SameLine();
            if (ImGui::Button("save picture"))
                save_picture();
            tip("save picture", "Saves the current picture as PNG and EXR under new names (p).");
            ImGui::SameLine();
            if (ImGui::Button("save scene"))
                save_scene();
            tip("save scene",
                "Saves the scene, with its changes and settings, as a scene file under a new name (Ctrl+S).");
            ImGui::Checkbox("numbers over the picture", &overlay_);
            tip("numbers over the picture", "Shows what runs, for how long, and what is left to do (o).");
            if (!message_.empty())
                ImGui::TextWrapped("%s", message_.c_str());
        }

        /// Asks before changes are lost. Returns whether it waits for the answer.
        bool draw_question()
        {
            constexpr const char* title = "The scene has changes that are not saved";
            if (std::exchange(asks_to_close_, false))
                ImGui::OpenPopup(title);
            if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove))
                return false;
            const auto answer = [](const char* label) {
                const bool chosen = ImGui::Button(label);
                placed(label);
                ImGui::SameLine();
                return chosen;
            };
            if (answer("save scene and close")) {
                save_scene();
                if (!saved_.lacks(document_.now()))
                    close_anyway();
                ImGui::CloseCurrentPopup();
            }
            if (answer("close without saving"))
                close_anyway();
            if (answer("stay"))
                ImGui::CloseCurrentPopup();
            ImGui::EndPopup();
            return true;
        }

        // --- keys ---
        void keys(bool asking)
        {
            const auto presses = keyboard_.take();
            if (asking || ImGui::GetIO().WantTextInput)
                return;
            for (const auto& p : presses)
                if (p.control)
                    command(p);
                else if (p.key == 'p' && !p.repeated)
                    save_picture();
                else if (p.key == 'o' && !p.repeated)
                    overlay_ = !overlay_;
                else if (p.key == keyboard::escape)
                    document_.select(std::nullopt);
                else
                    panel_.key(p, picture_.exposure());
        }
        void command(const key_press& p)
        {
            if (p.key == 'z')
                p.shift ? redo() : undo();
            else if (p.key == 'y')
                redo();
            else if (p.key == 's' && !p.repeated)
                save_scene();
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
            message_ = picture_.shown().number == 0 ? "there is no picture yet"
                                                    : saved_.save(picture_.shown().picture, picture_.exposure());
        }
        void save_scene() { message_ = saved_.save(document_.now()); }

        /// For --journal: where the controls are, when that has changed.
        void note_controls()
        {
            if (!journal_.is_open() || interface_.controls() == noted_controls_)
                return;
            noted_controls_ = interface_.controls();
            std::string places;
            for (const auto& [label, c] : noted_controls_)
                places += (places.empty() ? "\"" : ", \"") + label + "\": [" + std::to_string(c.x) + ", "
                    + std::to_string(c.y) + ", " + std::to_string(c.width) + ", " + std::to_string(c.height) + "]";
            note("{\"event\": \"controls\", \"places\": {" + places + "}}");
        }

        window_options options_;
        bool (*stop_asked_)();
        glfw glfw_;
        window_handle handle_;
        keyboard keyboard_;
        interface interface_;
        document document_;
        settings_panel panel_;
        picture_pane pane_;
        newest_picture picture_;
        saved_files saved_;
        std::mutex journal_guard_;
        std::ofstream journal_;

        version sent_;
        std::string message_;
        bool overlay_ = true;
        bool asks_to_close_ = false, closes_anyway_ = false;
        control_places noted_controls_;
        render_thread renderer_; ///< last: its thread ends first
    };
} // namespace

void photongrid_show_window(const window_options& o, bool (*stop_asked)()) { window(o, stop_asked).run(); }

} // namespace photongrid::viewer
