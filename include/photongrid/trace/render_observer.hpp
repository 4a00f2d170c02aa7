// Callbacks for the progress and the cancellation of a render.
#pragma once

#include <functional>
#include <stdexcept>
#include <string_view>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

struct image;

/// Thrown by a render when render_observer::cancelled returns true.
struct render_cancelled : std::runtime_error {
    /// "cancelled"
    render_cancelled() : std::runtime_error("cancelled") {}
};

/// Callbacks of a render. Each may be empty.
struct render_observer {
    /// "trace_photons", …; fraction of the stage, 0 to 1.
    std::function<void(std::string_view stage, double fraction)> progress;
    /// An unfinished picture: a preview, the running estimate (3.4) of a pass, or the mean of the passes so far.
    std::function<void(const image&)> intermediate;
    /// Called between passes of kernels; true: stop.
    std::function<bool()> cancelled;
};

namespace detail {
    /// \throws render_cancelled if the observer says so.
    inline void stop_if_cancelled(const render_observer& observer)
    {
        if (observer.cancelled && observer.cancelled())
            throw render_cancelled();
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
