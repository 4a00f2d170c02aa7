// Who watches a render, and may cancel it.
#pragma once

#include <functional>
#include <stdexcept>
#include <string_view>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

struct image;

/// Thrown out of a render when observer::cancelled said so.
struct render_cancelled : std::runtime_error {
    /// "cancelled"
    render_cancelled() : std::runtime_error("cancelled") {}
};

/// Who watches a render. Any of these may be empty.
struct render_observer {
    std::function<void(std::string_view stage, double fraction)>
        progress;                                   ///< "trace_photons", …; fraction of the stage, 0 to 1
    std::function<void(const image&)> intermediate; ///< the running estimate (3.4), after some passes
    std::function<bool()> cancelled;                ///< asked between passes
};

namespace detail {
    /// Advances `work` until it is finished; after each pass calls `passed`.
    /// \throws render_cancelled.
    template <class Work, class Passed>
    void run_to_end(Work& work, const render_observer& observer, Passed passed)
    {
        while (!work.finished()) {
            if (observer.cancelled && observer.cancelled())
                throw render_cancelled();
            work.advance();
            passed();
        }
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
