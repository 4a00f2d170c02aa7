// The radius of an estimate or a list of neighbours: the distance of each point's k-th nearest photon (exact_k), or a
// given radius (fixed_radius), or, in a block map, the next of a series of radii (at_least_k). Work per pass is
// bounded.
//
//     at_least_k, exact_k:
//                   kth_guess -> kth_distance -> kth_result -> kth_tie
//     fixed_radius: given_radius
#pragma once

#include <photongrid/estimate/given_radius.kernel.hpp>
#include <photongrid/estimate/knn_settings.hpp>
#include <photongrid/estimate/kth_distance.kernel.hpp>
#include <photongrid/estimate/kth_guess.kernel.hpp>
#include <photongrid/estimate/kth_result.kernel.hpp>
#include <photongrid/estimate/kth_tie.kernel.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The search for the radius of many points, which advances step by step. The photons that count are nearer than the
/// radius, or at the radius with an id up to the last one.
template <backend B>
class knn_radius {
public:
    /// `in.s.search` must be exact_k, fixed_radius or, in a block map, at_least_k.
    explicit knn_radius(const detail::search_inputs<B>& in);

    /// Runs at most `passes` more passes over the points that are not done.
    progress advance(uint passes = all_passes)
    {
        return detail::run_stages(
            passes, [this] { return finished(); }, [this](uint left) { return run_stage(left); },
            [this] { stage_ == stage::distance ? start_ties() : finish(); });
    }
    /// True when the radius of every point is known.
    bool finished() const { return stage_ == stage::finished; }

    /// Per point, y: photons visited so far.
    const buffer_of<B, glm::uvec4>& visited() const { return stage_ == stage::distance ? tally_ : chosen; }

    buffer_of<B, glm::vec4>
        radius{}; ///< once finished: x: squared radius, m^2; y: 1 if a photon set it, 0 if it was given
    buffer_of<B, glm::uvec4>
        chosen{}; ///< photons within the radius; photons visited; the last id that counts at the radius

private:
    enum class stage { distance, tie, finished };

    void start_distances();
    void start_ties();
    void finish()
    {
        stage_ = stage::finished;
        bracket_ = {};
        counts_ = {};
        cursor_ = {};
    }

    progress run_stage(uint passes);

    detail::search_inputs<B> in_;
    stage stage_ = stage::finished;
    // States. Each stage has its own and releases those of the stage before.
    buffer_of<B, glm::vec4> pivots_;
    buffer_of<B, glm::uvec4> counts_, outer_, bracket_, cursor_, tally_;
};

// Defined outside the class: functions defined inside are implicitly inline, and `extern template` does not suppress
// them.

template <backend B>
knn_radius<B>::knn_radius(const detail::search_inputs<B>& in) : in_(in)
{
    if (in_.s.search != search_kind::fixed_radius) {
        start_distances();
        return;
    }
    radius = in_.template make<glm::vec4>();
    chosen = in_.template make<glm::uvec4>();
    in_.device->template run<kernels::given_radius>(in_.points->size(),
        {.radius2 = in_.max_radius2(), .at_points = in_.s.radii_at_points ? 1u : 0u}, reads(*in_.points),
        writes(radius, chosen));
}

template <backend B>
void knn_radius<B>::start_distances()
{
    stage_ = stage::distance;
    pivots_ = in_.template make<glm::vec4>();
    counts_ = in_.template make<glm::uvec4>();
    outer_ = in_.template make<glm::uvec4>();
    bracket_ = in_.template make<glm::uvec4>();
    cursor_ = in_.template make<glm::uvec4>();
    tally_ = in_.template make<glm::uvec4>();
    in_.device->template run<kernels::kth_guess>(
        {in_.points->size(), 0u,
            in_.template blocks<kernels::kth_guess>() | in_.template together<kernels::kth_guess>()},
        {.grid = in_.map->cells_of,
            .k = in_.s.k,
            .max_radius2 = in_.max_radius2(),
            .rows = 1023u,
            .searching = in_.searching() ? 1u : 0u,
            .levels = in_.map->levels,
            .in_blocks = in_.map->in_blocks},
        reads(*in_.points, in_.map->cells, in_.map->boxes),
        writes(pivots_, counts_, outer_, bracket_, cursor_, tally_));
}

template <backend B>
void knn_radius<B>::start_ties()
{
    stage_ = stage::tie;
    radius = in_.template make<glm::vec4>();
    chosen = in_.template make<glm::uvec4>();
    auto ids = in_.template make<glm::uvec4>();
    in_.device->template run<kernels::kth_result>(in_.points->size(),
        {.k = in_.s.k,
            .photons = in_.map->photons.size(),
            .max_radius2 = in_.max_radius2(),
            .rounds_up = in_.s.search == search_kind::at_least_k ? 1u : 0u},
        reads(bracket_, tally_), writes(radius, chosen, ids, counts_, cursor_));
    bracket_ = std::move(ids);
    pivots_ = {};
    outer_ = {};
    tally_ = {};
}

template <backend B>
progress knn_radius<B>::run_stage(uint passes)
{
    B& device = *in_.device;
    const map_buffers<B>& m = *in_.map;
    const auto& s = in_.s;
    if (stage_ == stage::distance)
        return device.template run_until_done<kernels::kth_distance>(
            {in_.points->size(), 0u,
                in_.template map_switches<kernels::kth_distance>() | in_.template together<kernels::kth_distance>()},
            {.grid = m.cells_of,
                .leaks = in_.leaks(),
                .k = s.k,
                .max_radius2 = in_.max_radius2(),
                .visits = s.visits_per_pass,
                .ranges = s.ranges_per_pass,
                .levels = m.levels,
                .in_blocks = m.in_blocks},
            reads(*in_.points, in_.point_normals(), m.cells, m.photons.positions, in_.directions(),
                in_.photon_normals(), m.boxes),
            writes(pivots_, counts_, outer_, bracket_, cursor_, tally_), passes);
    return device.template run_until_done<kernels::kth_tie>(
        {in_.points->size(), 0u,
            in_.template map_switches<kernels::kth_tie>() | in_.template together<kernels::kth_tie>()},
        {.grid = m.cells_of,
            .leaks = in_.leaks(),
            .k = s.k,
            .photons = m.photons.size(),
            .visits = s.visits_per_pass,
            .ranges = s.ranges_per_pass,
            .levels = m.levels,
            .in_blocks = m.in_blocks},
        reads(*in_.points, in_.point_normals(), m.cells, m.photons.positions, in_.directions(), in_.photon_normals(),
            m.list, radius, m.boxes),
        writes(chosen, bracket_, counts_, cursor_), passes);
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
