// Searches for one point at a time on the host, in a copy of a map. They are const and may run in any thread. They find
// exactly the photons that the kernels find, because they compute distances and rows of cells by the same text
// (host_query.glsl).
#pragma once

#include <photongrid/estimate/host_guess.hpp>
#include <photongrid/estimate/host_query.kernel.hpp>
#include <photongrid/estimate/irradiance_estimate.kernel.hpp>
#include <photongrid/estimate/knn_settings.hpp>
#include <photongrid/map/own_photons.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A photon or point, by its index in the range that the map was made from.
using photon_id = uint;

/// The irradiance at a point.
///
/// Where there is no disc with k photons there is no estimate: radius is infinity, and value and errors are 0. That is
/// so if max_radius is unbounded and fewer than k photons count, as when leak policies reject most of them, and if the
/// point is not finite. With a bounded max_radius, fewer than k photons give an estimate over the whole disc.
struct irradiance_at_point {
    glm::vec3 value{0};     ///< W/m^2
    glm::vec3 error{0};     ///< standard error of value, W/m^2; 0 unless requested
    float error_of_sum = 0; ///< standard error of the channels' sum, W/m^2; 0 unless requested
    float radius = 0;       ///< radius of the photons' disc, m; infinity: no estimate
    uint count = 0;         ///< photons in the disc; without an estimate, photons found

    /// Whether `value` is an estimate.
    bool is_estimate() const { return std::isfinite(radius); }
};

namespace detail {
    /// What a search with settings `s` at p returns: `e`, or no estimate.
    inline irradiance_at_point estimate_or_none(irradiance_at_point e, const knn_settings& s, const glm::vec3& p)
    {
        const bool too_few = is_unbounded(s) && e.count < s.k;
        if (too_few || !kernels::is_finite(glm::vec4(p, 1)))
            return {.radius = std::numeric_limits<float>::infinity(), .count = e.count};
        return e;
    }
    inline void check_radius(float radius)
    {
        if (std::isnan(radius))
            throw std::invalid_argument("radius: NaN; expected a number, or infinity for no limit");
    }
} // namespace detail

/// Scratch memory for searches for one point. Each thread needs its own. Once it has grown to the largest search,
/// searches no longer allocate.
class query_scratch {
public:
    query_scratch() = default;

private:
    friend class host_search;
    struct candidate {
        std::uint64_t
            key;    ///< squared distance in the upper bits, id in the lower: the order in which photons are chosen
        uint index; ///< in the map
        bool operator<(const candidate& other) const { return key < other.key; }
    };
    std::vector<candidate> found_;
};

/// A map's photons in the host's memory: 36 bytes per photon, and 16 more each for directions and normals if the leak
/// policies need them.
class host_search {
public:
    host_search() = default;
    template <backend B>
    host_search(B& device, const map_buffers<B>& map, const knn_settings& settings, bool powers)
        : grid_(map.cells_of), levels_(map.levels), in_blocks_(map.in_blocks), extent_(map.extent()),
          cells_(device.download(map.cells)), boxes_(device.download(map.boxes)), list_(device.download(map.list)),
          positions_(device.download(map.photons.positions)), repeats_(map.may_repeat())
    {
        const auto& leaks = settings.leaks;
        settings_ = detail::checked(settings, map, 1, leaks.needs_point_normals() ? 1 : 0);
        if (powers)
            powers_ = device.download(map.photons.powers);
        if (leaks.side)
            directions_ = device.download(map.photons.directions);
        if (leaks.needs_photon_normals())
            normals_ = device.download(map.photons.normals);
    }

    const knn_settings& settings() const { return settings_; }

    /// Calls f(id, squared distance) for every photon within `radius` of p, in no particular order, without leak
    /// policies.
    /// \throws std::invalid_argument for a radius of NaN.
    template <class F>
    void for_each_within(const glm::vec3& p, float radius, const F& f) const
    {
        detail::check_radius(radius);
        const auto q = query({}, 0);
        const float radius2 = radius > 0 ? std::min(radius * radius, 1e38f) : -1.0f;
        visit(q, glm::vec4(p, 1), glm::vec4(0), radius2, [&](uint index, float d2) { f(photon_id{list_[index]}, d2); });
    }

    /// Calls f(id, squared distance) for the k nearest photons, nearest first; equal distances are ordered by id. f
    /// must not use `scratch`.
    /// \throws std::invalid_argument for k = 0 and a radius of NaN.
    template <class F>
    void for_each_nearest(const glm::vec3& p, uint k, float max_radius, query_scratch& scratch, const F& f) const
    {
        detail::check_radius(max_radius);
        if (k == 0)
            throw std::invalid_argument("for_each_nearest: k: 0; expected at least 1");
        auto s = settings_;
        s.k = k;
        s.max_radius = max_radius;
        s.search = search_kind::exact_k;
        s.leaks = {};
        const auto q = query({}, 0);
        const std::size_t n = collect(q, glm::vec4(p, 1), glm::vec4(0), s, scratch);
        auto& found = scratch.found_;
        std::sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(n));
        for (std::size_t i = 0; i < n; ++i)
            f(photon_id{static_cast<uint>(found[i].key)}, distance2_of(found[i]));
    }

    /// The estimate at p. It uses the same photons and radius as a search for many points; sums differ by at most
    /// 10^-6. `normal`: of the surface, if a leak policy needs it.
    /// \throws std::invalid_argument if the search is at_least_k.
    irradiance_at_point irradiance(const glm::vec3& p, const glm::vec3& normal, query_scratch& scratch) const
    {
        const auto& s = settings_;
        if (s.search == search_kind::at_least_k)
            throw std::invalid_argument("photon_map::irradiance: search: at_least_k is not available for a single "
                                        "point; use exact_k or fixed_radius, "
                                        "or search for many points at once");
        auto q
            = query(s.leaks, detail::policy_switches<kernels::host_query>(s.leaks) | detail::filter_switch(s.filter));
        const std::size_t n = collect(q, glm::vec4(p, 1), glm::vec4(normal, 0), s, scratch);
        const bool by_photon = s.search == search_kind::exact_k && n >= s.k;
        auto& found = scratch.found_;
        const auto last = by_photon ? std::max_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(n))
                                    : found.begin();
        const float max2 = detail::max_radius2(s);
        const float least2 = kernels::least_disc2(glm::vec4(p, 1), detail::min_radius2(s.min_radius));
        const float radius2 = by_photon ? distance2_of(*last) : max2;
        const auto search_radius = kernels::search_radius_of(radius2, by_photon);
        const bool excludes = s.bias == bias_kind::unbiased && kernels::excludes_photon(search_radius, least2);
        const float inverse = 1.0f / std::max(radius2, least2);
        glm::dvec4 sum(0), squares(0);
        for (std::size_t i = 0; i < n; ++i) {
            if (excludes && &found[i] == &*last)
                continue;
            const float t = std::min(distance2_of(found[i]) * inverse, 1.0f);
            const glm::vec4 weighted = powers_[found[i].index] * q.filter_weight(t);
            const float all = weighted.x + weighted.y + weighted.z;
            const double entries = repeats_ ? static_cast<double>(powers_[found[i].index].w) : 1.0;
            sum += glm::dvec4(weighted);
            squares += entries
                * glm::dvec4(weighted.x * weighted.x, weighted.y * weighted.y, weighted.z * weighted.z, all * all);
        }
        return detail::estimate_or_none(
            made_of(p, search_radius, glm::vec4(sum), glm::vec4(squares), static_cast<uint>(n)), s, p);
    }

private:
    static float distance2_of(const query_scratch::candidate& c)
    {
        return std::bit_cast<float>(static_cast<uint>(c.key >> 32));
    }
    kernels::host_query query(const leak_policy& l, uint switches) const
    {
        kernels::host_query q;
        q.args = {.grid = grid_,
            .leaks = {l.min_cosine, l.flattening * l.flattening - 1.0f, 0, 0},
            .levels = levels_,
            .in_blocks = in_blocks_};
        turn_switches(q, switches);
        q.bind(slot<0>{}, cells_);
        q.bind(slot<1>{}, positions_);
        q.bind(slot<2>{}, directions_);
        q.bind(slot<3>{}, normals_);
        q.bind(slot<4>{}, boxes_);
        return q;
    }

    /// Calls f(index, squared distance) for the photons within radius2.
    template <class F>
    static void visit(kernels::host_query q, const glm::vec4& p, const glm::vec4& n, float radius2, const F& f)
    {
        if (!(radius2 >= 0) || q.positions_data.empty() || !kernels::is_finite(p))
            return;
        const auto visit_range = [&](const glm::uvec2& range) {
            for (uint index = range.x; index < range.y; ++index)
                if (const float d2 = q.photon_distance2(index, p, n); d2 <= radius2)
                    f(index, d2);
        };
        if (!q.boxes_data.empty()) {
            for (auto place = kernels::at_first_node(); !kernels::has_ended(place);) {
                const bool near = q.is_near(place.x, p, radius2), block = q.is_block(place);
                if (near && block)
                    visit_range(q.photons_of_block(place.x));
                place = near && !block ? kernels::at_children(place) : kernels::after_nodes(place, 1);
            }
            return;
        }
        const auto& g = q.args.grid;
        const auto c = kernels::cell_coordinates(g, p);
        const float wide = q.wider(radius2);
        const auto rows_y = q.cells_within(p.y, wide, g.origin.y, g.inverse_cell.y, g.resolution.y),
                   rows_z = q.cells_within(p.z, wide, g.origin.z, g.inverse_cell.z, g.resolution.z);
        for (uint z = rows_z.x; z <= rows_z.y; ++z)
            for (uint y = rows_y.x; y <= rows_y.y; ++y)
                visit_range(q.photons_of_row(p, y, z, c, radius2));
    }

    /// Collects the photons that count in `scratch`, in no order. Returns how many there are.
    std::size_t collect(kernels::host_query q, const glm::vec4& p, const glm::vec4& n, const knn_settings& s,
        query_scratch& scratch) const
    {
        auto& found = scratch.found_;
        found.clear();
        if (!detail::is_searching(s, static_cast<uint>(positions_.size())) || !kernels::is_finite(p))
            return 0;
        const float max2 = detail::max_radius2(s);
        const bool exact = s.search == search_kind::exact_k;
        const float guess = boxes_.empty() ? detail::guessed_radius2(grid_, cells_, p, s.k, max2)
                                           : std::max(q.guessed_by_boxes(p, s.k), 1e-30f);
        float radius2 = exact ? std::min(1.3f * guess, max2) : max2;
        const float far2 = 16 * (extent_.x * extent_.x + extent_.y * extent_.y + extent_.z * extent_.z);
        for (;;) {
            found.clear();
            visit(q, p, n, radius2, [&](uint index, float d2) {
                found.push_back({std::uint64_t{std::bit_cast<uint>(d2)} << 32 | list_[index], index});
            });
            if (!exact)
                return found.size();
            if (found.size() >= s.k) {
                std::nth_element(found.begin(), found.begin() + (s.k - 1), found.end());
                return s.k;
            }
            if (radius2 >= max2)
                return found.size();
            const float missing
                = 1.3f * static_cast<float>(s.k) / static_cast<float>(std::max<std::size_t>(found.size(), 1));
            radius2
                = radius2 > far2 ? max2 : std::min(max2, std::max(radius2, 1e-30f) * std::clamp(missing, 1.5f, 8.0f));
        }
    }

    irradiance_at_point made_of(const glm::vec3& p, const glm::vec4& search_radius, const glm::vec4& sum,
        const glm::vec4& squares, uint held) const
    {
        const auto tally = kernels::search_tally(held, 0);
        const glm::vec4 point(p, 1);
        kernels::irradiance_estimate e;
        e.args = {.norm = detail::entry_of(settings_.filter).norm,
            .min_radius2 = detail::min_radius2(settings_.min_radius),
            .leave_out = settings_.bias == bias_kind::unbiased ? 1u : 0u};
        e.bind(slot<0>{}, std::span(&search_radius, 1));
        e.bind(slot<1>{}, std::span(&sum, 1));
        e.bind(slot<2>{}, std::span(&squares, 1));
        e.bind(slot<3>{}, std::span(&tally, 1));
        e.bind(slot<4>{}, std::span(&point, 1));
        e.kernel(0);
        return {
            glm::vec3(e.irradiance), glm::vec3(e.standard_error), e.standard_error.w, std::sqrt(e.irradiance.w), held};
    }

    grid grid_{};
    uint levels_ = 0, in_blocks_ = 0; ///< of a block map
    glm::vec3 extent_{0};             ///< of the map, m
    std::vector<glm::uvec2> cells_;
    std::vector<glm::vec4> boxes_;
    std::vector<uint> list_;
    std::vector<glm::vec4> positions_, powers_, directions_, normals_;
    bool repeats_ = false; ///< the map may hold a photon several times
    knn_settings settings_;
};

/// The searches for one point that photon_map and point_index have in common. They run in the calling thread, on a copy
/// in the host's memory; any number of threads may run them at the same time.
///
/// A point that is not finite has no neighbours.
class host_queries {
public:
    /// The origin of positions on the device.
    const glm::dvec3& origin() const { return origin_; }

    /// Calls f(photon_id, float distance2) for everything within `radius`, m, in no particular order. 0 or less:
    /// nothing; infinity: everything.
    /// \throws std::invalid_argument for a radius of NaN.
    template <detail::vector_like V, class F>
    void for_each_within(const V& point, float radius, const F& f) const
    {
        host_.for_each_within(local(point), radius, f);
    }

    /// The same for the k nearest, nearest first; equal distances are ordered by id. Each thread needs its own scratch,
    /// which f must not use.
    /// \throws std::invalid_argument for k = 0.
    template <detail::vector_like V, class F>
    void for_each_nearest(const V& point, uint k, query_scratch& scratch, const F& f) const
    {
        for_each_nearest(point, k, std::numeric_limits<float>::infinity(), scratch, f);
    }
    /// The same for those within `max_radius`, m, which may be fewer than k.
    /// \throws std::invalid_argument for k = 0 and a radius of NaN.
    template <detail::vector_like V, class F>
    void for_each_nearest(const V& point, uint k, float max_radius, query_scratch& scratch, const F& f) const
    {
        host_.for_each_nearest(local(point), k, max_radius, scratch, f);
    }
    /// The same with a scratch that each thread keeps. f may search as well.
    template <detail::vector_like V, class F>
    void for_each_nearest(const V& point, uint k, float max_radius, const F& f) const
    {
        query_scratch scratch = std::move(kept_scratch()); // so that a search by f has another
        for_each_nearest(point, k, max_radius, scratch, f);
        kept_scratch() = std::move(scratch);
    }
    /// The same without a largest radius.
    template <detail::vector_like V, class F>
    void for_each_nearest(const V& point, uint k, const F& f) const
    {
        for_each_nearest(point, k, std::numeric_limits<float>::infinity(), f);
    }

protected:
    explicit host_queries(const glm::dvec3& origin) : origin_(origin) {}

    /// A point as it is on the device.
    template <class V>
    glm::vec3 local(const V& point) const
    {
        return glm::vec3(detail::to_vec<double>(point) - origin_);
    }

    glm::dvec3 origin_;
    host_search host_;

private:
    /// The scratch of this thread, whatever f is.
    static query_scratch& kept_scratch()
    {
        thread_local query_scratch kept;
        return kept;
    }
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
