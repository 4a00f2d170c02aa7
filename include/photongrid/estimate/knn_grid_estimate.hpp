// The kNN-grid irradiance estimate (the paper's radiance estimate, section 2.3 and figure 6) and its extensions: a
// search for at least k photons, for the k nearest, or for all within a radius, followed by a density estimate with a
// standard error. Work per pass is bounded.
//
//     at_least_k, in a grid map; in a block map it goes the way of exact_k:
//                   knn_visit ----------------> knn_result          (the paper's: constant filter, no standard error)
//                             \-> grown_radius -> gather_photons -> irradiance_estimate
//     exact_k:      kth_guess -> kth_distance -> kth_result -> kth_tie -> gather_photons -> irradiance_estimate
//     fixed_radius: given_radius -------------------------------------> gather_photons -> irradiance_estimate
//
// Their biases, if they are asked for, come last (bias_sums.hpp).
#pragma once

#include <photongrid/core/zero_vectors.kernel.hpp>
#include <photongrid/estimate/bias_sums.hpp>
#include <photongrid/estimate/gather_photons.kernel.hpp>
#include <photongrid/estimate/gather_start.kernel.hpp>
#include <photongrid/estimate/grown_radius.kernel.hpp>
#include <photongrid/estimate/irradiance_estimate.kernel.hpp>
#include <photongrid/estimate/knn_radius.hpp>
#include <photongrid/estimate/knn_result.kernel.hpp>
#include <photongrid/estimate/knn_start.kernel.hpp>
#include <photongrid/estimate/knn_visit.kernel.hpp>
#include <photongrid/estimate/no_estimate.kernel.hpp>

#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Estimates per query point, in buffers.
template <backend B>
struct knn_estimates {
    buffer_of<B, glm::vec4> irradiance; ///< rgb, W/m^2: power / (pi r^2), weighted; w: r^2, m^2
    buffer_of<B, glm::uvec2> used;      ///< x: photons within r, y: photons visited
    /// rgb: standard error of irradiance, W/m^2; w: of the sum of its channels. Empty unless requested. It assumes that
    /// photons are independent and does not include bias. 0 if no photon was found; meaningless for k < 3, for which
    /// the variance is infinite. In a routed map a photon that stands for s photons of its cell counts as one of s
    /// times the power: where cells overflow, the error is up to sqrt(s) times too large.
    buffer_of<B, glm::vec4> standard_error;
    estimate_biases<B> biases{}; ///< empty unless requested; 0 if no photon was found, and while the search runs
};

/// A search for many points at once, which advances step by step; estimates so far can be read in between.
///
/// search_kind says which photons count. Squared distances are compared in single precision, computed as in
/// photon_distance.glsl, so that every backend finds the same photons. With fewer than k photons, r is max_radius. The
/// radiance of a Lambertian surface is irradiance x reflectance / pi.
template <backend B>
class knn_search_by_kernels {
public:
    /// A buffer of points, normals or sums.
    using vectors = buffer_of<B, glm::vec4>;

    /// `points`: xyz, m; points with w > 0 get an estimate. `map` and `points` must outlive the search.
    /// \throws std::invalid_argument for a radius of NaN, and for leak policies, since they need the points' normals.
    knn_search_by_kernels(B& device, const map_buffers<B>& map, const vectors& points, const knn_settings& s)
        : knn_search_by_kernels(device, map, points, nullptr, s)
    {
    }
    /// With the unit normals of the surfaces that the points lie on, on the side that is seen. They must outlive the
    /// search too.
    knn_search_by_kernels(
        B& device, const map_buffers<B>& map, const vectors& points, const vectors& normals, const knn_settings& s)
        : knn_search_by_kernels(device, map, points, &normals, s)
    {
    }

    // Temporaries would dangle.
    knn_search_by_kernels(B&, const map_buffers<B>&&, const vectors&, const knn_settings&) = delete;
    knn_search_by_kernels(B&, const map_buffers<B>&, const vectors&&, const knn_settings&) = delete;
    knn_search_by_kernels(B&, const map_buffers<B>&&, const vectors&, const vectors&, const knn_settings&) = delete;
    knn_search_by_kernels(B&, const map_buffers<B>&, const vectors&&, const vectors&, const knn_settings&) = delete;
    knn_search_by_kernels(B&, const map_buffers<B>&, const vectors&, const vectors&&, const knn_settings&) = delete;

    /// Whether estimates() has usable values while a search with settings `s` in a grid map is still running (3.4).
    static bool shows_running_estimate(const knn_settings& s) { return detail::sums_while_growing(s); }

    /// Runs at most `passes` more passes over the points that are not done. Work per pass and point is bounded.
    progress advance(uint passes = all_passes)
    {
        return detail::run_stages(
            passes, [this] { return stage_ == stage::finished; }, [this](uint left) { return run_stage(left); },
            [this] { next_stage(); });
    }

    /// The estimates: final once the search has finished. Before that they are running estimates if
    /// shows_running_estimate(), else incomplete sums, which are too small.
    knn_estimates<B> estimates();

private:
    enum class stage { grow, radius, gather, bias, finished };

    knn_search_by_kernels(
        B& device, const map_buffers<B>& map, const vectors& points, const vectors* normals, const knn_settings& s)
        : in_(device, map, points, normals, s)
    {
        if (in_.s.search == search_kind::at_least_k && !map.has_blocks()) {
            start_growing();
            return;
        }
        stage_ = stage::radius;
        radius_search_.emplace(in_);
        if (radius_search_->finished())
            next_stage();
    }

    void start_growing();

    void start_gathering();

    void next_stage();

    template <class K>
    uint gather_switches() const
    {
        const auto& s = in_.s;
        return in_.template map_switches<K>() | in_.template halved<K>() | in_.template repeats<K>()
            | detail::filter_switch(s.filter) | (s.bias == bias_kind::unbiased ? K::LEAVE_OUT_switch : 0u)
            | (s.errors ? K::ERRORS_switch : 0u) | in_.template together<K>();
    }

    progress run_stage(uint passes);

    knn_estimates<B> without_biases();
    /// After the last photon is summed.
    void begin_biases()
    {
        if (in_.s.biases)
            bias_sums_.emplace(in_, without_biases().irradiance);
        stage_ = in_.s.biases ? stage::bias : stage::finished;
    }

    detail::search_inputs<B> in_;
    stage stage_ = stage::finished;
    std::optional<knn_radius<B>> radius_search_;
    std::optional<detail::bias_sums<B>> bias_sums_;
    // States. Each stage has its own and releases those of the stage before.
    vectors gathered_, radius_, sum_, compensation_, squares_;
    buffer_of<B, glm::uvec4> found_, chosen_, cursor_, tally_;
};

// Defined outside the class: functions defined inside are implicitly inline, and `extern template` does not suppress
// them.

template <backend B>
knn_estimates<B> knn_search_by_kernels<B>::estimates()
{
    auto e = without_biases();
    if (in_.s.biases)
        e.biases
            = stage_ == stage::finished ? bias_sums_->biases() : detail::no_biases<B>(*in_.device, in_.points->size());
    return e;
}

template <backend B>
knn_estimates<B> knn_search_by_kernels<B>::without_biases()
{
    B& device = *in_.device;
    const auto n = in_.points->size();
    const auto& s = in_.s;
    knn_estimates<B> e{device.template make<glm::vec4>(n), device.template make<glm::uvec2>(n),
        device.template make<glm::vec4>(s.errors ? n : 0)};
    // Errors are 0 until photons are gathered; the contents of a new buffer are undefined.
    if (s.errors && (stage_ == stage::grow || stage_ == stage::radius))
        device.template run<kernels::zero_vectors>(n, {}, reads(), writes(e.standard_error));
    if (gathered_.size() > 0 || n == 0) {
        device.template run<kernels::knn_result>(n,
            {.k = s.k, .max_radius2 = in_.max_radius2(), .min_radius2 = in_.min_radius2()},
            reads(gathered_, found_, *in_.points), writes(e.irradiance, e.used));
        return e;
    }
    if (stage_ == stage::radius) {
        device.template run<kernels::no_estimate>(
            n, {.radius2 = in_.max_radius2()}, reads(radius_search_->visited()), writes(e.irradiance, e.used));
        return e;
    }
    auto errors = s.errors ? std::move(e.standard_error) : device.template make<glm::vec4>(n);
    device.template run<kernels::irradiance_estimate>(n,
        {.norm = detail::entry_of(s.filter).norm,
            .min_radius2 = in_.min_radius2(),
            .leave_out = s.bias == bias_kind::unbiased ? 1u : 0u},
        reads(radius_, sum_, squares_, tally_, *in_.points), writes(e.irradiance, e.used, errors));
    if (s.errors)
        e.standard_error = std::move(errors);
    return e;
}

template <backend B>
void knn_search_by_kernels<B>::start_growing()
{
    stage_ = stage::grow;
    gathered_ = in_.template make<glm::vec4>();
    found_ = in_.template make<glm::uvec4>();
    cursor_ = in_.template make<glm::uvec4>();
    in_.device->template run<kernels::knn_start>(in_.points->size(),
        {.grid = in_.map->cells_of, .searching = in_.searching() ? 1u : 0u}, reads(*in_.points),
        writes(gathered_, found_, cursor_));
}

template <backend B>
void knn_search_by_kernels<B>::start_gathering()
{
    stage_ = stage::gather;
    sum_ = in_.template make<glm::vec4>();
    compensation_ = in_.template make<glm::vec4>();
    squares_ = in_.template make<glm::vec4>();
    cursor_ = in_.template make<glm::uvec4>();
    tally_ = in_.template make<glm::uvec4>();
    in_.device->template run<kernels::gather_start>(in_.points->size(), {.searching = in_.searching() ? 1u : 0u},
        reads(*in_.points, chosen_), writes(sum_, compensation_, squares_, cursor_, tally_));
}

template <backend B>
void knn_search_by_kernels<B>::next_stage()
{
    switch (stage_) {
    case stage::grow:
        if (shows_running_estimate(in_.s)) {
            begin_biases(); // the growing search has already summed the photons
            return;
        }
        radius_ = in_.template make<glm::vec4>();
        chosen_ = in_.template make<glm::uvec4>();
        in_.device->template run<kernels::grown_radius>(in_.points->size(),
            {.k = in_.s.k, .max_radius2 = in_.max_radius2()}, reads(gathered_, found_), writes(radius_, chosen_));
        gathered_ = {};
        found_ = {};
        start_gathering();
        return;
    case stage::radius:
        radius_ = std::move(radius_search_->radius);
        chosen_ = std::move(radius_search_->chosen);
        radius_search_.reset();
        start_gathering();
        return;
    case stage::gather:
        compensation_ = {};
        cursor_ = {};
        begin_biases();
        return;
    case stage::bias: stage_ = stage::finished; return;
    case stage::finished: return;
    }
}

template <backend B>
progress knn_search_by_kernels<B>::run_stage(uint passes)
{
    B& device = *in_.device;
    const map_buffers<B>& m = *in_.map;
    const auto& s = in_.s;
    switch (stage_) {
    case stage::grow:
        return device.template run_until_done<kernels::knn_visit>(
            {in_.points->size(), 0u, in_.template policies<kernels::knn_visit>()},
            {.grid = m.cells_of,
                .leaks = in_.leaks(),
                .k = s.k,
                .max_radius2 = in_.max_radius2(),
                .visits = s.visits_per_pass,
                .ranges = s.ranges_per_pass},
            reads(*in_.points, in_.point_normals(), m.cells, m.photons.positions, in_.directions(),
                in_.photon_normals(), m.photons.powers),
            writes(gathered_, found_, cursor_), passes);
    case stage::radius: return radius_search_->advance(passes);
    case stage::gather: {
        return device.template run_until_done<kernels::gather_photons>(
            {in_.points->size(), 0u, gather_switches<kernels::gather_photons>()},
            {.grid = m.cells_of,
                .leaks = in_.leaks(),
                .min_radius2 = in_.min_radius2(),
                .visits = s.visits_per_pass,
                .ranges = s.ranges_per_pass,
                .levels = m.levels,
                .in_blocks = m.in_blocks},
            reads(*in_.points, in_.point_normals(), m.cells, m.photons.positions, in_.directions(),
                in_.photon_normals(), m.list, m.photons.powers, m.boxes),
            writes(radius_, chosen_, sum_, compensation_, squares_, cursor_, tally_), passes);
    }
    case stage::bias: return bias_sums_->advance(passes);
    case stage::finished: break;
    }
    progress nothing;
    nothing.finished = true;
    return nothing;
}

/// The search on backend B: by kernels, unless the backend has an override (its folder overrides/).
/// \snippet snippets.cpp knn_search
template <backend B>
class knn_search : public knn_search_by_kernels<B> {
public:
    using knn_search_by_kernels<B>::knn_search_by_kernels;
};
/// Deduces the backend from the first argument.
template <backend B, class... Rest>
knn_search(B&, const map_buffers<B>&, const Rest&...) -> knn_search<B>;

/// Runs a whole search (2.3). `points`: xyz, m; points with w > 0 get an estimate.
/// \throws std::invalid_argument as knn_search does, backend_error when the device cannot hold the search.
/// \snippet snippets.cpp knn_grid_estimate
template <backend B>
knn_estimates<B> knn_grid_estimate(
    B& device, const map_buffers<B>& map, const buffer_of<B, glm::vec4>& points, const knn_settings& settings)
{
    knn_search<B> search(device, map, points, settings);
    search.advance();
    return std::move(search).estimates();
}
/// With the unit normals of the surfaces that the points lie on, for leak policies.
/// \snippet snippets.cpp upload_normals
template <backend B>
knn_estimates<B> knn_grid_estimate(B& device, const map_buffers<B>& map, const buffer_of<B, glm::vec4>& points,
    const buffer_of<B, glm::vec4>& normals, const knn_settings& settings)
{
    knn_search<B> search(device, map, points, normals, settings);
    search.advance();
    return std::move(search).estimates();
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
