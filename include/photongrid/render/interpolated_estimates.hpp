// The estimates at the hits of one eye ray, of which those between others that are near are interpolated (the paper's
// section 4.5; docs/design/decisions.md, "Interpolated estimates"). Three rounds, from coarse to fine:
//
//     round 0: search at the corners of tiles of 8 x 8 pixels
//     round 1: interpolate in those tiles; elsewhere, search at the corners of tiles of 4 x 4, 8 x 1 or 1 x 8 pixels
//     round 2: interpolate in those tiles; search at all other pixels
//
// A pixel's estimate is interpolated if the four corners of its tile are on the same surface, each at most
// estimate_settings::interpolation radii of its own estimate away. The distance to the k-th nearest photon changes by
// at most the way that one goes, so that a search there would have found a radius of at least 1 - interpolation of
// those at the corners: photons that crowd between corners are not missed.
#pragma once

#include <photongrid/render/interpolation_round.kernel.hpp>
#include <photongrid/render/marked_points.hpp>
#include <photongrid/render/point_estimates.hpp>
#include <photongrid/render/row_bands.hpp>

#include <tuple>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Whether the estimates of a search are interpolated, if they may be `spacing` radii apart. Not where the radius is
/// that of the paper's search: it depends on the cells of the grid.
inline bool is_interpolated(const knn_settings& s, double spacing)
{
    return spacing > 0 && s.search != search_kind::at_least_k;
}

/// The pixels of an eye ray's hits.
struct estimate_pixels {
    glm::uvec2 size{}; ///< of the band of the picture
    /// The largest distance of an estimate that others are interpolated from, in its radius; 0: none are.
    double spacing = 0;
    bool are_few = false; ///< few of them want an estimate; these are searched for apart from the others
};

/// The estimates at the hits of one eye ray, one per pixel.
template <backend B>
class interpolated_estimates {
public:
    /// A buffer of points or normals.
    using vectors = buffer_of<B, glm::vec4>;

    /// `points` (recentred, m; w > 0: an estimate is wanted) and their unit `normals` must outlive it. `kind`: what is
    /// shown while estimates are computed; of those that are interpolated, nothing is.
    /// \throws std::invalid_argument as knn_search does, backend_error.
    interpolated_estimates(B& device, const estimate_sources<B>& from, const estimate_pixels& pixels,
        const vectors& points, const vectors& normals, running_estimate_kind kind, step_size step);

    /// Runs a step. Returns whether the estimates are finished.
    bool advance();

    /// Whether the next step improves the estimates that are shown.
    bool is_shown() const { return whole_ && whole_->is_shown(); }
    /// Whether there are estimates to show.
    bool has_running_estimates() const { return whole_ && whole_->has_running_estimates(); }
    /// The estimates so far, for display, if there are any.
    knn_estimates<B> running_estimates() { return whole_->running_estimates(); }
    /// About the number of points whose estimates are not finished.
    std::uint64_t unfinished() const
    {
        return whole_ ? whole_->unfinished() : round_ <= last_round ? points_.size() * (3 - round_) / 3 : 0;
    }

    /// The estimates. They must be finished.
    knn_estimates<B> take() { return whole_ ? whole_->take() : std::move(estimates_); }

private:
    static constexpr uint last_round = 2, only_round = 3; ///< see interpolation_round.glsl

    void begin_round();

    B& device_;
    estimate_sources<B> from_;
    float spacing2_;
    glm::uvec2 size_;
    const vectors& points_;
    const vectors& normals_;
    step_size step_;
    std::optional<point_estimates<B>> whole_; ///< where nothing is interpolated
    uint round_ = 0;
    knn_estimates<B> estimates_;        ///< those of the rounds so far
    buffer_of<B, uint> states_;         ///< see interpolation_round.glsl
    detail::marked_points<B> searched_; ///< in this round
    vectors places_, place_normals_;    ///< those points
    std::optional<point_estimates<B>> of_round_;
};

// Defined outside the class: functions defined inside are implicitly inline, and `extern template` does not suppress
// them.

template <backend B>
interpolated_estimates<B>::interpolated_estimates(B& device, const estimate_sources<B>& from,
    const estimate_pixels& pixels, const vectors& points, const vectors& normals, running_estimate_kind kind,
    step_size step)
    : device_(device), from_(from), spacing2_(static_cast<float>(pixels.spacing * pixels.spacing)), size_(pixels.size),
      points_(points), normals_(normals), step_(step)
{
    if (!is_interpolated(from_.search, pixels.spacing))
        round_ = only_round;
    // The paper's search may be shown while it runs.
    if (round_ == only_round && (!pixels.are_few || from_.search.search == search_kind::at_least_k)) {
        whole_.emplace(device_, from_, points_, normals_, kind, step_);
        return;
    }
    const auto n = points_.size();
    const auto make = [&](bool wanted) { return device_.template make<glm::vec4>(wanted ? n : 0); };
    const bool errors = from_.search.errors, biases = from_.search.biases;
    // Contents are undefined; the first round reads none of them.
    estimates_ = {make(true), device_.template make<glm::uvec2>(n), make(errors),
        {make(biases), make(biases), make(biases), make(biases)}};
    states_ = device_.template make<uint>(n);
}

template <backend B>
void interpolated_estimates<B>::begin_round()
{
    const auto n = points_.size();
    auto states = device_.template make<uint>(n);
    device_.template run<kernels::interpolation_round>(n, {.size = size_, .number = round_, .spacing2 = spacing2_},
        reads(points_, normals_, states_, estimates_.irradiance), writes(states));
    states_ = std::move(states);
    searched_ = {device_, states_};
    std::tie(places_, place_normals_) = searched_.gather(device_, points_, normals_);
    of_round_.emplace(device_, from_, places_, place_normals_, running_estimate_kind::none, step_);
}

template <backend B>
bool interpolated_estimates<B>::advance()
{
    if (whole_)
        return whole_->advance();
    if (!of_round_)
        begin_round();
    if (!of_round_->advance())
        return false;
    detail::take_estimates(device_, size_, states_, searched_, of_round_->take(), estimates_);
    of_round_.reset();
    return round_++ >= last_round;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
