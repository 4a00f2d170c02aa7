// Callbacks for the progress and the cancellation of a render.
#pragma once

#include <functional>
#include <stdexcept>
#include <string_view>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

struct image;

/// Thrown by a render when render_observer::cancelled returns true.
struct render_cancelled : std::runtime_error {
    /// "cancelled"
    render_cancelled() : std::runtime_error("cancelled") {}
};

/// Callbacks of a render. Each may be empty.
struct render_observer {
    std::function<void(std::string_view stage, double fraction)>
        progress;                                   ///< "trace_photons", …; fraction of the stage, 0 to 1
    std::function<void(const image&)> intermediate; ///< the running estimate (3.4), after some passes
    std::function<bool()> cancelled;                ///< called between passes; true: stop
};

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
