// The window: its loop, its panel and what keys do.
#include "window.hpp"

#include "display.hpp"
#include "journal_file.hpp"
#include "newest_picture.hpp"
#include "picture_pane.hpp"
#include "question.hpp"
#include "saved_files.hpp"
#include "settings_panel.hpp"
#include "window_input.hpp"
#include <photongrid/backends/any/module.hpp>
#include <photongrid/io/import/scene_files.hpp>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

PHOTONGRID_MODULE

namespace photongrid::viewer {

namespace {
    constexpr float panel_width = 330;
    constexpr GLenum context_lost = 0x0507; // GL_CONTEXT_LOST

    class window {
    public:
        window(const window_options& o, bool (*stop_asked)())
            : stop_asked_(stop_asked), handle_(open_window(o.begin.settings, panel_width)), input_(handle_.get()),
              interface_(handle_.get()), in_file_{o.begin.scene, o.begin.settings, o.renderer.backend},
              document_(in_file_), panel_(document_), pane_(document_), picture_(renderer_, pane_, o.reference),
              saved_(o.begin), journal_(o.journal), scenes_(o.open, glfwPostEmptyEvent, o.reloads),
              renderer_(
                  o.make, o.renderer, glfwPostEmptyEvent,
                  o.journal.empty() ? journal() : [this](const std::string& line) { journal_.note(line); })
        {
            scenes_.watch(o.begin);
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
                take_dropped();
                take_scenes();
                draw();
                if (glGetError() == context_lost)
                    throw backend_error("view: the window's OpenGL context was lost (driver reset); open it again, or "
                                        "use --backend cpu if the renderer draws on the same GPU");
                ++turns;
                const double ms = 1000 * (glfwGetTime() - begin);
                slowest_ms = std::max(slowest_ms, ms);
                slow_turns += ms > 1000.0 / 30 ? 1u : 0u;
            }
            journal_.note_end(turns, slow_turns, slowest_ms);
        }

    private:
        /// Whether the window closes. If that would lose changes, its user is asked first.
        bool closes()
        {
            if (glfwWindowShouldClose(handle_.get()) == GLFW_FALSE)
                return false;
            if (closes_anyway_ || !saved_.lacks(document_.now()))
                return true;
            glfwSetWindowShouldClose(handle_.get(), GLFW_FALSE);
            ask(question::about::closing);
            return false;
        }
        void close_anyway()
        {
            closes_anyway_ = true;
            glfwSetWindowShouldClose(handle_.get(), GLFW_TRUE);
        }

        void ask(question::about what)
        {
            constexpr std::array words{"closing", "opening", "reading again"};
            journal_.note("asks", "about", words[static_cast<std::size_t>(what)]);
            question_.ask(what);
            glfwPostEmptyEvent();
        }
        void take_answer(question::about what, question::answer given)
        {
            if (given == question::answer::stay && what == question::about::reading_again)
                message_ = "the scene stays as it is until one of its files changes again";
            if (given == question::answer::save)
                save_scene(); // says why if it cannot
            const bool stays
                = given == question::answer::stay || (given == question::answer::save && saved_.lacks(document_.now()));
            if (what != question::about::closing)
                stays ? next_.reset() : take_scene();
            else if (!stays)
                close_anyway();
        }

        // --- scenes that come ---
        void take_dropped()
        {
            const auto paths = input_.take_dropped();
            if (paths.empty())
                return;
            constexpr std::array pictures{".exr", ".hdr", ".pfm", ".png", ".jpg", ".jpeg", ".tga"};
            const auto scene = std::find_if(paths.begin(), paths.end(), [&](const std::string& path) {
                return std::find(pictures.begin(), pictures.end(), ending_of(path)) == pictures.end();
            });
            if (scene == paths.end()) {
                refuse(paths.front()
                    + ": is a picture, not a scene; environments and textures are named in the scene's file");
                return;
            }
            message_ = "reading " + *scene;
            scenes_.open(*scene);
        }
        /// What the thread that reads scenes has read; not while the mouse holds a part of the present one.
        void take_scenes()
        {
            if (question_.asked() || ImGui::IsAnyMouseDown())
                return;
            if (!next_)
                next_ = scenes_.take();
            if (!next_)
                return;
            if (!next_->scene) {
                refuse(next_->error);
                next_.reset();
            } else if (saved_.lacks(document_.now()) && (!next_->again || moves_parts(document_.now(), in_file_))) {
                ask(next_->again ? question::about::reading_again : question::about::opening);
            } else {
                take_scene();
            }
        }
        void refuse(const std::string& why)
        {
            scene_error_ = why;
            message_.clear();
            journal_.note("refused", "why", why);
        }
        /// The next scene takes the present one's place.
        void take_scene()
        {
            const bool again = next_->again;
            const auto next = std::move(*next_->scene);
            next_.reset();
            const auto was = std::exchange(in_file_, {next.scene, next.settings, document_.now().backend});
            document_ = document(again ? read_again(document_.now(), was, in_file_) : in_file_);
            panel_.begin_anew();
            saved_ = saved_files(next);
            if (!again) {
                picture_.forget_reference();
                scenes_.watch(next);
            }
            scene_error_.clear();
            message_ = (again ? "read again: " : "opened: ") + std::filesystem::path(next.path).filename().string();
            if (next.notes > 0)
                message_ += "; notes: " + std::to_string(next.notes) + " (`photongrid check` prints them)";
            journal_.note(again ? "read again" : "opened", "scene", next.path);
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
            if (!scene_error_.empty())
                draw_scene_error(scene_error_);
            ImGui::End();
            ImGui::SetNextWindowPos({size.x - panel_width, 0});
            ImGui::SetNextWindowSize({panel_width, size.y});
            ImGui::Begin("settings", nullptr, fixed & ~ImGuiWindowFlags_NoScrollbar);
            draw_panel();
            ImGui::End();
            keys(draw_question());
            journal_.note(interface_.controls());
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
            draw_buttons(); // above the settings, which may need to be scrolled
            ImGui::Separator();
            panel_.draw(picture_.exposure());
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

        /// Returns whether a question waits for its answer.
        bool draw_question()
        {
            const auto about = question_.asked();
            if (const auto given = question_.draw())
                take_answer(*about, *given);
            return about.has_value();
        }

        // --- keys ---
        void keys(bool asking)
        {
            const auto presses = input_.take_keys();
            if (asking || ImGui::GetIO().WantTextInput)
                return;
            for (const auto& p : presses)
                if (p.control)
                    command(p);
                else if (p.key == 'p' && !p.repeated)
                    save_picture();
                else if (p.key == 'o' && !p.repeated)
                    overlay_ = !overlay_;
                else if (p.key == key_press::escape)
                    leave();
                else
                    panel_.key(p, picture_.exposure());
        }
        void leave()
        {
            document_.select(std::nullopt);
            scene_error_.clear();
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

        bool (*stop_asked_)();
        glfw glfw_;
        window_handle handle_;
        window_input input_;
        interface interface_;
        version in_file_; ///< the scene as its file has it
        document document_;
        settings_panel panel_;
        picture_pane pane_;
        newest_picture picture_;
        saved_files saved_;
        journal_file journal_;
        question question_;

        version sent_;
        std::string message_, scene_error_;
        bool overlay_ = true, closes_anyway_ = false;
        std::optional<scene_news> next_; ///< a scene that waits to take the present one's place
        scene_thread scenes_;
        render_thread renderer_; ///< last: its thread ends first
    };
} // namespace

void photongrid_show_window(const window_options& o, bool (*stop_asked)()) { window(o, stop_asked).run(); }

} // namespace photongrid::viewer
