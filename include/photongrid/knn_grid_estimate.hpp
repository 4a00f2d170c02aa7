// The kNN-grid radiance estimate (section 2.3, figure 6) and what goes beyond it: a search that finds at least k photons, the
// k nearest, or all within a radius, then a density estimate from them, with its standard error. A bounded amount of work a
// pass.
//
//     at_least_k:   knn_visit ----------------> knn_result          (the paper's: constant kernel, no error asked for)
//                             \-> grown_radius -> gather_photons -> irradiance_estimate
//     exact_k:      kth_guess -> kth_distance -> kth_result -> kth_tie -> gather_photons -> irradiance_estimate
//     fixed_radius: given_radius -------------------------------------> gather_photons -> irradiance_estimate
#pragma once

#include <photongrid/estimate_settings.hpp>
#include <photongrid/photon_map.hpp>

namespace photongrid {

/// What to search for.
struct knn_settings {
    uint k = 50;              ///< photons wanted; all within max_radius are taken when there are fewer. Not for fixed_radius
    float max_radius = 0;     ///< m; photons farther away are always rejected. 0 or less: nothing is found
    float min_radius = 0;     ///< m; the disc of the estimate is never smaller. 0: 2^-20 of the grid's largest extent
    search_kind search = search_kind::exact_k;
    filter_kernel kernel = filter_kernel::constant;
    bias_kind bias = bias_kind::unbiased;
    leak_policy leaks{};
    bool errors = false;      ///< standard errors are wanted
    /// Photons that one query examines in a pass at most, and rows of cells that it opens. Any values give the same
    /// result. 16 lanes x (visits + rows) must stay well below 65,535, after which llvmpipe and lavapipe end loops in silence:
    /// some loops more go round once a scan.
    uint visits_per_pass = 3072;
    uint ranges_per_pass = 896;
};

/// The radius, m, below which the disc of an estimate never shrinks where the caller names none: 2^-20 of the largest extent.
inline float least_radius(const grid& g)
{
    const auto extent = glm::vec3(g.cell) * glm::vec3(g.resolution);
    return std::max({extent.x, extent.y, extent.z}) * 0x1p-20f;
}

/// The paper's own choice (2.3).
inline knn_settings as_paper(knn_settings s)
{
    s.search = search_kind::at_least_k;
    s.kernel = filter_kernel::constant;
    s.bias = bias_kind::paper;
    s.leaks = {};
    return s;
}

namespace detail {
    /// `s` with the least radius filled in, or an exception that says what is wrong with it for this map and these points.
    template <backend B>
    knn_settings checked(knn_settings s, const photon_map<B>& map, std::size_t points, std::size_t normals)
    {
        if (std::isnan(s.max_radius) || std::isnan(s.min_radius))
            throw std::invalid_argument("knn_search: max_radius, min_radius: NaN");
        if (s.visits_per_pass < 1 || s.ranges_per_pass < 2)
            throw std::invalid_argument("knn_search: visits_per_pass, ranges_per_pass: need at least 1 and 2, or a pass gets nowhere");
        if (!(s.leaks.compression >= 1) || !(s.leaks.compression <= 1e6f) || !(s.leaks.min_cosine >= -1) || !(s.leaks.min_cosine <= 1))
            throw std::invalid_argument("knn_search: leaks: compression must be from 1 to 10^6, min_cosine from -1 to 1");
        if (s.leaks.needs_any() && normals < points)
            throw std::invalid_argument("knn_search: leaks: a policy needs the surface normal of every query point");
        if (s.leaks.side && map.photons.size() > 0 && map.photons.directions.size() == 0)
            throw std::invalid_argument("knn_search: leaks: side needs the photons' directions, which this map does not keep");
        if (s.leaks.needs_normals() && map.photons.size() > 0 && map.photons.normals.size() == 0)
            throw std::invalid_argument("knn_search: leaks: min_cosine needs the photons' surface normals, which this map does not keep");
        if (!(s.min_radius > 0))
            s.min_radius = least_radius(map.cells_of);
        return s;
    }
    /// True when something can be found at all.
    inline bool is_searching(const knn_settings& s, uint photons) { return photons > 0 && s.max_radius > 0 && (s.k > 0 || s.search == search_kind::fixed_radius); }
    /// The squares that kernels take, m^2.
    inline float max_radius2(const knn_settings& s)
    {
        const float r = s.max_radius;
        return r > 0 ? std::min(r * r, 1e38f) : 0.0f;
    }
    inline float min_radius2(const knn_settings& s) { return std::max(s.min_radius * s.min_radius, 1e-36f); }
    /// Do points lie so close to each other that neighbours should search together? Where the radius that is to be expected is
    /// eight times their distance; both are of as many as lie on the largest side of the grid's box, evenly.
    template <backend B>
    bool are_close(const knn_settings& s, const photon_map<B>& map, std::size_t points)
    {
        const auto e = glm::dvec3(map.cells_of.cell) * glm::dvec3(map.cells_of.resolution);
        const double area = std::max({e.x * e.y, e.y * e.z, e.z * e.x});
        const double photons = std::max(1.0, static_cast<double>(map.photons.size()));
        double disc = 3.14159265 * static_cast<double>(max_radius2(s));
        if (s.search != search_kind::fixed_radius)
            disc = std::min(disc, area * static_cast<double>(s.k) / photons);
        return disc / 3.14159265 * static_cast<double>(points) >= 64 * area;
    }
    /// 1 / mean of the kernel over its disc.
    constexpr float norm_of(filter_kernel k)
    {
        constexpr float norms[] = {1, 3, 2, 3};
        return norms[static_cast<int>(k)];
    }
} // namespace detail

/// Estimates per query point, in buffers.
template <backend B>
struct knn_estimates {
    buffer_of<B, glm::vec4> irradiance; ///< rgb, W/m^2: flux / (pi r^2), weighted; w: r^2, m^2
    buffer_of<B, glm::uvec2> used;      ///< x: photons within r, y: photons visited
    /// rgb: standard error of irradiance, W/m^2; w: of the sum of its channels. Empty where none was asked for. It takes the
    /// photons as independent; it does not see bias. 0 where no photon was found; meaningless for k < 3, whose variance is
    /// infinite.
    buffer_of<B, glm::vec4> standard_error;
};

/// A search for many points at once, that can be advanced, looked at and advanced again.
///
/// Which photons count is stated at search_kind; "distance" is compared as squares, in single precision, summed x, y, z as
/// photon_distance.glsl writes it, so that every backend finds the same set. With fewer than k, r is max_radius. Radiance of
/// a Lambertian surface is irradiance x reflectance / pi.
template <backend B>
class knn_search_by_kernels {
public:
    using vectors = buffer_of<B, glm::vec4>;

    /// Points: xyz in m; w > 0 marks a point that wants an estimate. `map` and `points` must outlive the search.
    /// \throws std::invalid_argument for a radius that is NaN, and for leak policies, which need normals of the points.
    knn_search_by_kernels(B& b, const photon_map<B>& map, const vectors& points, const knn_settings& s)
        : knn_search_by_kernels(b, map, points, nullptr, s)
    {
    }
    /// With the unit normals of the surfaces that the points lie on, towards the side that is looked at. They must outlive
    /// the search too.
    knn_search_by_kernels(B& b, const photon_map<B>& map, const vectors& points, const vectors& normals, const knn_settings& s)
        : knn_search_by_kernels(b, map, points, &normals, s)
    {
    }

    /// Runs at most `passes` more passes over the points not yet done.
    progress advance(uint passes = nowhere)
    {
        progress all;
        while (stage_ != stage::finished && all.passes < passes) {
            const progress p = run_stage(passes - all.passes);
            all.passes += p.passes;
            all.active.insert(all.active.end(), p.active.begin(), p.active.end());
            if (!p.finished)
                break;
            next_stage();
        }
        all.finished = stage_ == stage::finished;
        return all;
    }

    /// The estimates from what is held now. Final ones when the search has finished; before, at_least_k gives running ones
    /// (3.4), and the other searches what was added up so far, which is too little.
    knn_estimates<B> estimates()
    {
        B& b = *b_;
        const auto n = points_->size();
        knn_estimates<B> e{b.template make<glm::vec4>(n), b.template make<glm::uvec2>(n), b.template make<glm::vec4>(s_.errors ? n : 0)};
        if (gathered_.size() > 0 || n == 0) {
            b.template run<kernels::knn_result>(n, {.wanted = s_.k, .max_radius2 = max_radius2(), .min_radius2 = min_radius2()}, reads(gathered_, found_), writes(e.irradiance, e.used));
            return e;
        }
        if (stage_ != stage::gather && stage_ != stage::finished) {
            b.template run<kernels::no_estimate>(n, {.radius2 = max_radius2()}, reads(stage_ == stage::tie ? chosen_ : tally_), writes(e.irradiance, e.used));
            return e;
        }
        auto errors = s_.errors ? std::move(e.standard_error) : b.template make<glm::vec4>(n);
        b.template run<kernels::irradiance_estimate>(n,
            {.norm = detail::norm_of(s_.kernel), .min_radius2 = min_radius2(), .left_out = s_.bias == bias_kind::unbiased ? 1u : 0u},
            reads(reach_, sum_, squares_, tally_), writes(e.irradiance, e.used, errors));
        if (s_.errors)
            e.standard_error = std::move(errors);
        return e;
    }

private:
    enum class stage { grow, distance, tie, gather, finished };

    knn_search_by_kernels(B& b, const photon_map<B>& map, const vectors& points, const vectors* normals, const knn_settings& s)
        : b_(&b), map_(&map), points_(&points), normals_(normals), s_(detail::checked(s, map, points.size(), normals != nullptr ? normals->size() : 0))
    {
        switch (s_.search) {
        case search_kind::at_least_k: start_growing(); break;
        case search_kind::exact_k: start_distances(); break;
        case search_kind::fixed_radius:
            reach_ = make<glm::vec4>();
            chosen_ = make<glm::uvec4>();
            b.template run<kernels::given_radius>(points.size(), {.radius2 = max_radius2()}, reads(), writes(reach_, chosen_));
            start_gathering();
            break;
        }
    }

    template <class T>
    buffer_of<B, T> make() { return b_->template make<T>(points_->size()); }

    bool searching() const { return detail::is_searching(s_, map_->photons.size()); }

    void start_growing()
    {
        stage_ = stage::grow;
        gathered_ = make<glm::vec4>();
        found_ = make<glm::uvec4>();
        cursor_ = make<glm::uvec4>();
        b_->template run<kernels::knn_start>(points_->size(), {.grid = map_->cells_of, .searching = searching() ? 1u : 0u}, reads(*points_), writes(gathered_, found_, cursor_));
    }

    void start_distances()
    {
        stage_ = stage::distance;
        pivots_ = make<glm::vec4>();
        counts_ = make<glm::uvec4>();
        outer_ = make<glm::uvec4>();
        bracket_ = make<glm::uvec4>();
        cursor_ = make<glm::uvec4>();
        tally_ = make<glm::uvec4>();
        b_->template run<kernels::kth_guess>({points_->size(), 0u, detail::are_close(s_, *map_, points_->size()) ? 1u << kernels::kth_guess::group_switch : 0u},
            {.grid = map_->cells_of, .wanted = s_.k, .max_radius2 = max_radius2(), .rows = 1023u, .searching = searching() ? 1u : 0u}, reads(*points_, map_->cells),
            writes(pivots_, counts_, outer_, bracket_, cursor_, tally_));
    }

    void start_gathering()
    {
        stage_ = stage::gather;
        sum_ = make<glm::vec4>();
        lost_ = make<glm::vec4>();
        squares_ = make<glm::vec4>();
        cursor_ = make<glm::uvec4>();
        tally_ = make<glm::uvec4>();
        b_->template run<kernels::gather_start>(points_->size(), {.searching = searching() ? 1u : 0u}, reads(*points_, chosen_), writes(sum_, lost_, squares_, cursor_, tally_));
    }

    void next_stage()
    {
        B& b = *b_;
        const auto n = points_->size();
        switch (stage_) {
        case stage::grow:
            if (s_.kernel == filter_kernel::constant && s_.bias == bias_kind::paper && !s_.errors) {
                stage_ = stage::finished; // the growing search has added up the photons
                return;
            }
            reach_ = make<glm::vec4>();
            chosen_ = make<glm::uvec4>();
            b.template run<kernels::grown_radius>(n, {.wanted = s_.k, .max_radius2 = max_radius2()}, reads(gathered_, found_), writes(reach_, chosen_));
            gathered_ = {};
            found_ = {};
            start_gathering();
            return;
        case stage::distance: {
            reach_ = make<glm::vec4>();
            chosen_ = make<glm::uvec4>();
            auto ids = make<glm::uvec4>();
            b.template run<kernels::kth_result>(n, {.wanted = s_.k, .photons = map_->photons.size(), .max_radius2 = max_radius2()}, reads(bracket_, tally_), writes(reach_, chosen_, ids, counts_, cursor_));
            bracket_ = std::move(ids);
            pivots_ = {};
            outer_ = {};
            tally_ = {};
            stage_ = stage::tie;
            return;
        }
        case stage::tie:
            bracket_ = {};
            counts_ = {};
            start_gathering();
            return;
        case stage::gather:
            stage_ = stage::finished;
            lost_ = {};
            cursor_ = {};
            return;
        case stage::finished: return;
        }
    }

    progress run_stage(uint passes)
    {
        B& b = *b_;
        const photon_map<B>& m = *map_;
        // What no policy asks for is never read; any buffer stands in for it.
        const vectors& normals = normals_ != nullptr ? *normals_ : *points_;
        const vectors& directions = s_.leaks.side ? m.photons.directions : m.photons.positions;
        const vectors& photon_normals = s_.leaks.needs_normals() ? m.photons.normals : m.photons.positions;
        const glm::vec4 leaks(s_.leaks.min_cosine, s_.leaks.compression * s_.leaks.compression - 1.0f, 0.0f, 0.0f);
        const uint policies = (s_.leaks.side ? 1u : 0u) | (s_.leaks.needs_normals() ? 2u : 0u) | (s_.leaks.compression > 1 ? 4u : 0u);
        const bool together = detail::are_close(s_, m, points_->size());
        const launch points(points_->size(), 0u, policies | (together ? 1u << kernels::kth_distance::group_switch : 0u));
        switch (stage_) {
        case stage::grow:
            return b.template run_until_done<kernels::knn_visit>(points,
                {.grid = m.cells_of, .leaks = leaks, .wanted = s_.k, .max_radius2 = max_radius2(), .visits = s_.visits_per_pass, .ranges = s_.ranges_per_pass},
                reads(*points_, normals, m.cells, m.photons.positions, directions, photon_normals, m.photons.powers), writes(gathered_, found_, cursor_), passes);
        case stage::distance:
            return b.template run_until_done<kernels::kth_distance>(points,
                {.grid = m.cells_of, .leaks = leaks, .wanted = s_.k, .max_radius2 = max_radius2(), .visits = s_.visits_per_pass, .ranges = s_.ranges_per_pass},
                reads(*points_, normals, m.cells, m.photons.positions, directions, photon_normals), writes(pivots_, counts_, outer_, bracket_, cursor_, tally_), passes);
        case stage::tie:
            return b.template run_until_done<kernels::kth_tie>(points,
                {.grid = m.cells_of, .leaks = leaks, .wanted = s_.k, .photons = m.photons.size(), .visits = s_.visits_per_pass, .ranges = s_.ranges_per_pass},
                reads(*points_, normals, m.cells, m.photons.positions, directions, photon_normals, m.list, reach_), writes(chosen_, bracket_, counts_, cursor_), passes);
        case stage::gather: {
            const uint kernel = s_.kernel == filter_kernel::constant ? 0u : 4u << static_cast<uint>(s_.kernel); // SWITCHes 3 to 5
            const uint how = policies | kernel | (s_.bias == bias_kind::unbiased ? 1u << 6 : 0u) | (s_.errors ? 1u << 7 : 0u) | (together ? 1u << kernels::gather_photons::group_switch : 0u);
            return b.template run_until_done<kernels::gather_photons>({points_->size(), 0u, how},
                {.grid = m.cells_of, .leaks = leaks, .min_radius2 = min_radius2(), .visits = s_.visits_per_pass, .ranges = s_.ranges_per_pass},
                reads(*points_, normals, m.cells, m.photons.positions, directions, photon_normals, m.list, m.photons.powers),
                writes(reach_, chosen_, sum_, lost_, squares_, cursor_, tally_), passes);
        }
        case stage::finished: break;
        }
        progress nothing;
        nothing.finished = true;
        return nothing;
    }

    float max_radius2() const { return detail::max_radius2(s_); }
    float min_radius2() const { return detail::min_radius2(s_); }

    B* b_;
    const photon_map<B>* map_;
    const vectors* points_;
    const vectors* normals_;
    knn_settings s_;
    stage stage_ = stage::finished;
    // States; each stage holds its own and gives up the last one's.
    vectors gathered_, pivots_, reach_, sum_, lost_, squares_;
    buffer_of<B, glm::uvec4> found_, counts_, outer_, bracket_, chosen_, cursor_, tally_;
};

/// The search of backend B: by kernels, unless the backend has another (backends/<name>/overrides/).
template <backend B>
class knn_search : public knn_search_by_kernels<B> {
public:
    using knn_search_by_kernels<B>::knn_search_by_kernels;
};
template <backend B, class... Rest>
knn_search(B&, const photon_map<B>&, const Rest&...) -> knn_search<B>;

/// The whole search at once.
template <backend B>
knn_estimates<B> knn_grid_estimate(B& b, const photon_map<B>& map, const buffer_of<B, glm::vec4>& points, const knn_settings& settings)
{
    knn_search<B> search(b, map, points, settings);
    search.advance();
    return std::move(search).estimates();
}
template <backend B>
knn_estimates<B> knn_grid_estimate(B& b, const photon_map<B>& map, const buffer_of<B, glm::vec4>& points, const buffer_of<B, glm::vec4>& normals, const knn_settings& settings)
{
    knn_search<B> search(b, map, points, normals, settings);
    search.advance();
    return std::move(search).estimates();
}

} // namespace photongrid
