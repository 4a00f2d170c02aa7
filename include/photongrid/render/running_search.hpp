// The search at the hits of an eye ray, which can be shown while it runs (3.4).
#pragma once

#include <photongrid/estimate/knn_grid_estimate.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// How much work a stage does per step, between possible interruptions.
enum class step_size {
    largest, ///< as much as the device can do at once: no interruptions needed
    small,   ///< some ms on a CPU: the picture is displayed or may be cancelled
};

/// What is shown of a search while it runs.
enum class running_estimate_kind {
    none,      ///< nothing
    own,       ///< its partial sums
    by_kernels ///< those of a search by kernels that runs first, since the backend's own search has none
};

/// What can be shown of a search with settings `s`, if anything is wanted, and if the search may run twice.
template <backend B>
running_estimate_kind running_estimate_of(const knn_settings& s, bool wanted, bool may_search_twice)
{
    if (!wanted)
        return running_estimate_kind::none;
    if (knn_search<B>::shows_running_estimate(s))
        return running_estimate_kind::own;
    return may_search_twice && knn_search_by_kernels<B>::shows_running_estimate(s) ? running_estimate_kind::by_kernels
                                                                                   : running_estimate_kind::none;
}

/// The search at the hits of one eye ray, in steps. The estimates at its end do not depend on what is shown before.
template <backend B>
class running_search {
public:
    /// A buffer of points or normals.
    using vectors = buffer_of<B, glm::vec4>;

    /// `map`, `points` and their `normals` must outlive it.
    /// \throws std::invalid_argument as knn_search does, backend_error.
    running_search(B& device, const map_buffers<B>& map, const vectors& points, const vectors& normals,
        const knn_settings& s, running_estimate_kind kind, step_size size);

    /// Runs a step. Returns whether the search is finished.
    bool advance();

    /// Whether the next step improves the estimates that are shown.
    bool is_shown() const { return kind_ == running_estimate_kind::own || (by_kernels_ && !search_); }
    /// The estimates so far, for display.
    knn_estimates<B> running_estimates() { return by_kernels_ ? by_kernels_->estimates() : search_->estimates(); }
    /// The number of points whose estimates are not finished.
    std::uint64_t unfinished() const { return unfinished_; }

    /// The estimates. The search must be finished.
    knn_estimates<B> take() { return std::move(*search_).estimates(); }

private:
    B& device_;
    const map_buffers<B>& map_;
    const vectors& points_;
    const vectors& normals_;
    knn_settings settings_;
    running_estimate_kind kind_;
    step_size size_;
    std::optional<knn_search_by_kernels<B>> by_kernels_; ///< if that kind is shown; kept until the end, for display
    std::optional<knn_search<B>> search_;                ///< begins once by_kernels_ has finished
    uint passes_shown_ = 0;
    std::uint64_t unfinished_;
};

// Defined outside the class: functions defined inside are implicitly inline, and `extern template` does not suppress
// them.

template <backend B>
running_search<B>::running_search(B& device, const map_buffers<B>& map, const vectors& points, const vectors& normals,
    const knn_settings& s, running_estimate_kind kind, step_size size)
    : device_(device), map_(map), points_(points), normals_(normals), settings_(s), kind_(kind), size_(size),
      unfinished_(points.size())
{
    if (kind_ != running_estimate_kind::none) {
        settings_.visits_per_pass = 256;
        settings_.ranges_per_pass = 64;
    }
    if (kind_ == running_estimate_kind::by_kernels)
        by_kernels_.emplace(device_, map_, points_, normals_, settings_);
    else
        search_.emplace(device_, map_, points_, normals_, settings_);
}

template <backend B>
bool running_search<B>::advance()
{
    const bool shown = is_shown(); // after 1, 2, 4, 8, ... passes
    const uint passes = size_ == step_size::largest ? all_passes : shown ? std::max(1u, passes_shown_) : 8u;
    const auto did = search_ ? search_->advance(passes) : by_kernels_->advance(passes);
    if (shown)
        passes_shown_ += passes;
    if (did.finished && !search_) {
        search_.emplace(device_, map_, points_, normals_, settings_);
        return false;
    }
    if (did.finished)
        unfinished_ = 0;
    else if (!did.active.empty())
        unfinished_ = did.active.back();
    return did.finished;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
