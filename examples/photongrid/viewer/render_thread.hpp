// The window's renderer, in a thread of its own: takes versions to draw, returns pictures as they are made.
#pragma once

#include "document.hpp"
#include <photongrid/backends/any/any.hpp>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace photongrid::viewer {

/// A picture, its number and its times.
struct frame {
    std::uint64_t request = 0; ///< which request it answers
    std::uint64_t number = 0;  ///< pictures since the window opened; 0: none
    image picture;
    double ms = 0;     ///< since the request was begun
    double change = 0; ///< relMSE of the previous picture to this one; 0 for the first of a request
};

/// The renderer's progress.
struct render_report {
    std::uint64_t request = 0; ///< being drawn
    bool whole = false;        ///< it is drawn: no more pictures of it
    render_progress progress{};
    render_stats stats{};
    std::uint64_t maps = 0;   ///< begun since the backend was opened
    std::uint64_t passes = 0; ///< on the device, since the backend was opened
    std::string backend{};    ///< as --backend takes it
    std::string device{};
    std::string error{}; ///< why the last request is not drawn; empty if it is
};

/// An event for --journal: one line of JSON without the line break.
using journal = std::function<void(const std::string& line)>;

/// make_renderer(), or what takes its place: the window is a module, and the backends are the program's.
using renderer_maker = std::unique_ptr<renderer> (*)(const renderer_options&);

class render_thread {
public:
    /// Time after which a step ends, so that the thread reports its progress.
    static constexpr renderer::milliseconds usual_step_time{8};

    /// `wake` is called in this object's thread when there is a new picture or state; `log` may be empty.
    render_thread(renderer_maker make, renderer_options options, std::function<void()> wake, journal log,
        renderer::milliseconds step_time = usual_step_time);
    ~render_thread();
    render_thread(const render_thread&) = delete;
    render_thread& operator=(const render_thread&) = delete;

    /// From now on draws `v`. The current drawing ends after its pass. `moving` means that more requests will follow
    /// soon; then the current drawing continues until its first preview. Returns the request's number.
    std::uint64_t show(const version& v, bool moving);

    /// The newest picture, if its number is above `seen`.
    std::optional<frame> newer_than(std::uint64_t seen) const;
    render_report report() const;

private:
    struct request {
        version what;
        bool moving = false;
        std::uint64_t number = 0;
        std::uint64_t passes_before = 0; ///< on the device, before the step during which it was made
        std::chrono::steady_clock::time_point made{};
    };
    void work();
    void draw();
    bool take();
    void publish(double ms);
    void fail(const std::string& what);
    void tell(const std::string& event, const std::string& more = "") const;
    render_settings settings_to_draw() const;

    renderer_maker make_;
    renderer_options options_;
    std::function<void()> wake_;
    journal log_;
    const renderer::milliseconds step_time_;
    const std::chrono::steady_clock::time_point opened_ = std::chrono::steady_clock::now();

    mutable std::mutex guard_;
    std::condition_variable changed_;
    std::optional<request> requested_; ///< not taken yet
    bool ends_ = false;
    std::uint64_t requests_ = 0;
    frame newest_;
    render_report report_;
    renderer* cancellable_ = nullptr;       ///< the renderer, while it may be cancelled
    std::atomic<std::uint64_t> passes_ = 0; ///< on the device, up to the last step

    // Used by the thread only.
    std::unique_ptr<renderer> renderer_;
    std::string opened_backend_;
    request current_;
    std::optional<request> chosen_for_; ///< the request for which settings were chosen last
    render_settings chosen_;
    bool drawing_ = false;
    std::uint64_t seen_ = 0; ///< pictures of the current request
    std::optional<image> last_;
    std::chrono::steady_clock::time_point begun_{};

    std::thread thread_;
};

} // namespace photongrid::viewer
