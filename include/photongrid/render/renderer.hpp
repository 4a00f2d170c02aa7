// A picture that is started, run step by step, looked at at any time, changed and cancelled (section 3.4), whatever the
// backend. progressive_render<B> is one; make_renderer (backends/any/any.hpp) makes one on a backend that is chosen at
// run time.
#pragma once

#include <photongrid/backend/backend.hpp>
#include <photongrid/render/previews.hpp>
#include <photongrid/render/render_state.hpp>
#include <photongrid/render/render_stats.hpp>

#include <atomic>
#include <chrono>
#include <limits>
#include <map>
#include <string>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// One thread starts, steps and looks; any may cancel.
class renderer {
public:
    using milliseconds = std::chrono::duration<double, std::milli>; ///< of a step
    /// Of a step that ends with the picture.
    static constexpr milliseconds no_limit{std::numeric_limits<double>::infinity()};

    renderer() = default;
    renderer(const renderer&) = delete;
    renderer& operator=(const renderer&) = delete;
    virtual ~renderer() = default;

    /// From now on draws `s`, seen by its camera. Work in flight is given up, but for a map that serves the new picture
    /// too (same_map). Cheap: all work is step's.
    /// \throws std::invalid_argument for a scene or settings that check() refuses; what was drawn before is then still
    ///         there.
    /// \snippet snippets.cpp progressive_render
    virtual void start(const scene& s, const render_settings& settings, const preview_settings& previews = {}) = 0;
    /// Goes on from a state() of the same scene, settings and device, without previews: the picture ends with the same
    /// bytes. To be called after start() and before step().
    /// \throws std::invalid_argument for a state of another size; step() for one with more rays than there are.
    virtual void resume(render_state s) = 0;
    /// What the picture has so far, for resume().
    virtual render_state state() = 0;

    /// Works for about `budget`: whole steps, at least one, until time is up, the picture is finished, or another
    /// thread cancels. Returns whether the picture is finished.
    /// \throws std::logic_error before start(), std::runtime_error when the lights store too few photons,
    ///         backend_error. The next step begins the picture anew.
    virtual bool step(milliseconds budget = no_limit) = 0;
    /// Makes the step that runs in another thread end after the pass of the device in flight, whatever its budget. The
    /// next step goes on; start() begins anew.
    void cancel() { stop_asked_ = true; }

    /// True when picture() is the picture.
    bool finished() const { return started_ && film_.passes() == settings_.output.passes; }
    /// How many pictures there have been since start(), each better than the last; 0: picture() has nothing to show.
    std::uint64_t pictures() const { return pictures_; }
    /// The best picture so far, in the whole size: the mean of the finished passes; before there is one, the mean of
    /// the first pass's samples, a running estimate (3.4), or the last preview. NaN and infinite pixels are 0.
    /// \throws std::logic_error when there is none yet, backend_error.
    virtual image picture() = 0;

    /// Where it is.
    virtual render_progress progress() const = 0;
    /// Of the maps and passes so far; whole when finished.
    const render_stats& stats() const { return stats_; }
    /// Maps that were begun since this object was made.
    virtual std::uint64_t maps() const = 0;

    // Of the backend.
    virtual const capabilities& caps() const = 0;
    virtual const std::map<std::string, kernel_cost>& costs() const = 0;

protected:
    bool started_ = false;
    render_settings settings_;
    film film_;
    render_stats stats_;
    std::uint64_t pictures_ = 0;
    std::atomic<bool> stop_asked_ = false;
};

/// The whole picture, and what it took. The observer's `intermediate` is not called.
/// \throws what start() and step() throw, render_cancelled.
[[nodiscard]] inline rendered render(
    renderer& device, const scene& s, const render_settings& settings, const render_observer& observer = {})
{
    const bool watched = observer.progress || observer.cancelled;
    device.start(s, settings, {.enabled = false});
    while (!device.step(watched ? renderer::milliseconds(0) : renderer::no_limit)) {
        if (observer.cancelled && observer.cancelled())
            throw render_cancelled();
        if (observer.progress) {
            const auto now = device.progress();
            observer.progress(now.stage, now.fraction);
        }
    }
    return {device.picture(), device.stats()};
}
/// The same with the scene's own settings.
[[nodiscard]] inline rendered render(renderer& device, const scene& s) { return render(device, s, s.render); }

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
