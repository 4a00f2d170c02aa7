// The interface of progressive rendering, independent of the backend: a picture is started, advanced in steps,
// displayed at any time, changed and cancelled (section 3.4). progressive_render<B> implements it; make_renderer
// (backends/any/any.hpp) creates one on a backend chosen at run time.
#pragma once

#include <photongrid/core/backend.hpp>
#include <photongrid/render/previews.hpp>
#include <photongrid/render/render_state.hpp>
#include <photongrid/render/render_stats.hpp>

#include <atomic>
#include <chrono>
#include <limits>
#include <map>
#include <string>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// One thread at a time may use it; any thread may call cancel().
class renderer {
public:
    using milliseconds = std::chrono::duration<double, std::milli>; ///< the budget of a step
    /// The budget of a step that ends with the picture.
    static constexpr milliseconds no_limit{std::numeric_limits<double>::infinity()};

    renderer() = default;
    renderer(const renderer&) = delete;
    renderer& operator=(const renderer&) = delete;
    virtual ~renderer() = default;

    /// Starts a picture of `s` with its camera. Work on the picture before is discarded, except for a map that the new
    /// picture can use (same_map). It returns at once; step() does the work, the choice of automatic settings first.
    /// \throws std::invalid_argument for a scene or settings that check() rejects; the picture before is then kept.
    /// \snippet snippets.cpp progressive_render
    virtual void start(const scene& s, const render_settings& settings, const preview_settings& previews = {}) = 0;
    /// Continues from a state() of the same scene, settings and device, without previews. The finished picture has the
    /// same bytes. Call it after start() and before step(), but for steps that choose settings.
    /// \throws std::invalid_argument for the state of another picture: of another size, with passes that this one does
    ///         not have, or with other bands. step() throws it for a state with too many rays.
    /// \throws std::logic_error before start(), for automatic settings, or once the picture has begun.
    virtual void resume(render_state s) = 0;
    /// The state so far, for resume().
    virtual render_state state() = 0;

    /// Works for about `budget`: at least one step, until the time is up, the picture is finished, or another thread
    /// cancels. Returns whether the picture is finished.
    /// \throws std::logic_error before start(), backend_error.
    ///         After an exception the next step starts the picture again.
    virtual bool step(milliseconds budget = no_limit) = 0;
    /// Makes a step that runs in another thread return after the current device pass. The next step continues; start()
    /// starts a new picture.
    void cancel() { stop_asked_ = true; }

    /// Whether picture() is the finished picture: all its passes are done, or a stop rule has ended it. A picture that
    /// output_settings::seconds ended within its first pass is the best so far, and stats().end has no passes.
    bool finished() const { return started_ && stats_.end.by != ended_by::nothing; }
    /// The settings of the picture: those that start() was given, with numbers in place of automatic ones as soon as
    /// they are chosen. They are the same on every machine for the same scene, settings and backend.
    const render_settings& settings() const { return settings_; }

    /// The number of pictures since start(), each better than the one before; 0: there is none yet. A resumed state
    /// with finished passes is one.
    std::uint64_t pictures() const { return pictures_; }
    /// The best picture so far, in full size: the mean of the finished passes or, before the first is finished, the
    /// mean of its samples, a running estimate (3.4), or the last preview. NaN and infinite pixels are 0.
    /// \throws std::logic_error if there is none yet, backend_error.
    virtual image picture() = 0;

    /// The progress.
    virtual render_progress progress() const = 0;
    /// Statistics of the maps and passes so far; complete when finished.
    const render_stats& stats() const { return stats_; }
    /// How many maps were started since this object was created.
    virtual std::uint64_t maps() const = 0;

    /// What the backend's device can do.
    virtual const capabilities& caps() const = 0;
    /// The cost of each of the backend's kernels so far.
    virtual const std::map<std::string, kernel_cost>& costs() const = 0;

protected:
    bool started_ = false;
    render_settings settings_;
    film film_;
    render_stats stats_;
    std::uint64_t pictures_ = 0;
    std::atomic<bool> stop_asked_ = false;
};

/// The settings of a picture of `s`, with numbers in place of automatic ones. It starts that picture.
/// \throws what start() and step() throw.
[[nodiscard]] inline render_settings chosen_settings(renderer& device, const scene& s, const render_settings& settings)
{
    device.start(s, settings);
    while (is_automatic(device.settings()))
        device.step(renderer::milliseconds(0));
    return device.settings();
}

/// Renders a whole picture. The observer's `intermediate`, if there is one, is called with previews, then with each
/// better picture before the last.
/// \throws what start() and step() throw, render_cancelled.
[[nodiscard]] inline rendered render(
    renderer& device, const scene& s, const render_settings& settings, const render_observer& observer = {})
{
    const bool shows = static_cast<bool>(observer.intermediate);
    const bool watched = observer.progress || observer.cancelled || shows;
    device.start(s, settings, {.enabled = shows});
    for (std::uint64_t shown = 0; !device.step(watched ? renderer::milliseconds(0) : renderer::no_limit);) {
        detail::stop_if_cancelled(observer);
        if (observer.progress) {
            const auto now = device.progress();
            observer.progress(now.stage, now.fraction);
        }
        if (shows && device.pictures() > shown)
            observer.intermediate(device.picture());
        shown = device.pictures();
    }
    return {device.picture(), device.stats()};
}
/// The same with the scene's own settings.
[[nodiscard]] inline rendered render(renderer& device, const scene& s) { return render(device, s, s.render); }

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
