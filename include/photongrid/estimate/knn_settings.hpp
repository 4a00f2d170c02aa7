// The settings of a search, and their conversion to the parameters of kernels.
#pragma once

#include <photongrid/estimate/estimate_settings.hpp>
#include <photongrid/map/map_buffers.hpp>

#include <limits>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The settings of a search.
struct knn_settings {
    uint k = 50; ///< photons sought; fewer if max_radius holds fewer. Not used by fixed_radius
    float max_radius = std::numeric_limits<float>::infinity(); ///< m; photons farther away are rejected; 0 or less:
                                                               ///< none is found. fixed_radius needs a finite one
    float min_radius = 0; ///< m; least radius of the estimate's disc. It is never below 2^-24 of the point's largest
                          ///< coordinate, by which rounding may have moved photons, nor below 1e-18 m
    search_kind search = search_kind::exact_k; ///< which photons count
    /// fixed_radius: each point has a radius of its own. Its w is the square, m^2; max_radius is the largest allowed.
    bool radii_at_points = false;
    filter_kind filter = filter_kind::constant; ///< weight by distance
    bias_kind bias = bias_kind::unbiased;       ///< whether the photon that sets the radius counts
    leak_policy leaks{};                        ///< leak rejection; none by default
    bool errors = false;                        ///< compute standard errors
    bool biases = false;                        ///< compute biases (bias_sums.hpp)
    /// The most photons that one query examines in a pass, at least 1. Results depend neither on this nor on
    /// ranges_per_pass. llvmpipe and lavapipe silently end loops after 65,535 iterations, counted over all 16 lanes of
    /// a subgroup: there, visits_per_pass + ranges_per_pass must be at most 3,968, which is 4,095 per lane less 127 for
    /// the loops around those over photons and rows.
    uint visits_per_pass = 3072;
    uint ranges_per_pass = 896; ///< the most rows of cells or boxes that one query reads in a pass, at least 2
    /// radii_at_points: photons beyond a plane do not count, which the w of a point's normal gives, or 0 for none
    /// (half_space.glsl).
    bool half_spaces = false;
};

/// The paper's choice (2.3): at least k, constant filter, no leak policy. k, radii and errors are unchanged.
/// \snippet snippets.cpp as_paper
inline knn_settings as_paper(knn_settings s)
{
    s.search = search_kind::at_least_k;
    s.filter = filter_kind::constant;
    s.bias = bias_kind::paper;
    s.leaks = {};
    return s;
}

namespace detail {
    /// Whether a search by kernels with settings `s` sums the light while its radius grows, so that estimates can be
    /// shown before it ends (2.4, 3.4): the paper's estimate.
    inline bool sums_while_growing(const knn_settings& s)
    {
        return s.search == search_kind::at_least_k && s.filter == filter_kind::constant && s.bias == bias_kind::paper
            && !s.errors;
    }

    /// `s`. Throws if the settings do not suit this map and these points.
    template <backend B>
    knn_settings checked(knn_settings s, const map_buffers<B>& map, std::size_t points, std::size_t normals)
    {
        if (std::isnan(s.max_radius) || std::isnan(s.min_radius))
            throw std::invalid_argument("knn_search: max_radius, min_radius: NaN");
        if (s.radii_at_points && s.search != search_kind::fixed_radius)
            throw std::invalid_argument("knn_search: radii_at_points: only search_kind::fixed_radius has given radii");
        if (s.half_spaces && (!s.radii_at_points || normals < points))
            throw std::invalid_argument(
                "knn_search: half_spaces: needs radii_at_points and the surface normal of every query point");
        if (s.search == search_kind::fixed_radius && !s.radii_at_points && std::isinf(s.max_radius) && s.max_radius > 0)
            throw std::invalid_argument(
                "knn_search: max_radius: infinite; search_kind::fixed_radius takes all photons within it, so set one");
        if (s.k < 1 && s.search != search_kind::fixed_radius)
            throw std::invalid_argument(
                "knn_search: k: 0; set at least 1, or use search_kind::fixed_radius for all photons "
                "within a radius");
        if (s.visits_per_pass < 1 || s.ranges_per_pass < 2)
            throw std::invalid_argument("knn_search: visits_per_pass, ranges_per_pass: must be at least 1 and 2, so "
                                        "that a pass makes progress");
        if (!(s.leaks.flattening >= 1) || !(s.leaks.flattening <= 1e6f) || !(s.leaks.min_cosine >= -1)
            || !(s.leaks.min_cosine <= 1))
            throw std::invalid_argument(
                "knn_search: leaks: flattening must be from 1 to 10^6, min_cosine from -1 to 1");
        if (s.leaks.needs_point_normals() && normals < points)
            throw std::invalid_argument("knn_search: leaks: a policy needs the surface normal of every query point");
        if (s.leaks.side && map.photons.size() > 0 && map.photons.directions.size() == 0)
            throw std::invalid_argument(
                "knn_search: leaks: side needs the photons' directions, which this map does not keep");
        if (s.leaks.needs_photon_normals() && map.photons.size() > 0 && map.photons.normals.size() == 0)
            throw std::invalid_argument(
                "knn_search: leaks: min_cosine needs the photons' surface normals, which this map does not keep");
        return s;
    }
    /// Whether a search can find anything.
    inline bool is_searching(const knn_settings& s, uint photons)
    {
        return photons > 0 && s.max_radius > 0 && (s.k > 0 || s.search == search_kind::fixed_radius);
    }
    /// Squared radii, m^2, as kernels need them.
    inline float max_radius2(const knn_settings& s)
    {
        const float r = s.max_radius;
        return r > 0 ? std::min(r * r, 1e38f) : 0.0f;
    }
    /// Whether the radius has no limit: no photon is found beyond.
    inline bool is_unbounded(const knn_settings& s)
    {
        return s.search != search_kind::fixed_radius && max_radius2(s) >= 1e38f;
    }
    /// The parameter of least_disc2 (search_radius.glsl), m^2, for a least radius in m.
    inline float min_radius2(float min_radius)
    {
        return min_radius > 0 ? std::max(min_radius * min_radius, 1e-36f) : 1e-36f;
    }
    /// The SWITCHes of kernel K that photon_distance.glsl reads.
    template <class K>
    uint policy_switches(const leak_policy& l)
    {
        return (l.side ? K::SIDE_switch : 0u) | (l.needs_photon_normals() ? K::NORMALS_switch : 0u)
            | (l.flattening > 1 ? K::FLATTEN_switch : 0u);
    }
    /// Whether the points are close enough for neighbours to search in a subgroup: if the expected radius is at least
    /// eight times the distance between points. Both are estimated as if points and photons were evenly distributed
    /// over the largest side of the map's box.
    template <backend B>
    bool are_close(const knn_settings& s, const map_buffers<B>& map, std::size_t points)
    {
        const glm::dvec3 e(map.extent());
        const double area = std::max({e.x * e.y, e.y * e.z, e.z * e.x});
        const double photons = std::max(1.0, static_cast<double>(map.photons.size()));
        double disc = 3.14159265 * static_cast<double>(max_radius2(s));
        if (s.search != search_kind::fixed_radius || s.radii_at_points) // those are mostly of about k photons
            disc = std::min(disc, area * static_cast<double>(s.k) / photons);
        return disc / 3.14159265 * static_cast<double>(points) >= 64 * area;
    }
    /// A search and the buffers that its kernels read. The pointers must stay valid while it is used.
    template <backend B>
    struct search_inputs {
        using vectors = buffer_of<B, glm::vec4>;
        B* device;
        const map_buffers<B>* map;
        const vectors* points;
        const vectors* normals; ///< of the points; null if there are none
        knn_settings s;

        search_inputs(B& device_, const map_buffers<B>& map_, const vectors& points_, const vectors* normals_,
            const knn_settings& s_)
            : device(&device_), map(&map_), points(&points_), normals(normals_),
              s(checked(s_, map_, points_.size(), normals_ != nullptr ? normals_->size() : 0))
        {
        }
        template <element T>
        buffer_of<B, T> make() const
        {
            return device->template make<T>(points->size());
        }
        bool searching() const { return is_searching(s, map->photons.size()); }
        float max_radius2() const { return detail::max_radius2(s); }
        float min_radius2() const { return detail::min_radius2(s.min_radius); }
        // Attributes that no policy needs are not read; another buffer is bound in their place.
        const vectors& point_normals() const { return normals != nullptr ? *normals : *points; }
        const vectors& directions() const { return s.leaks.side ? map->photons.directions : map->photons.positions; }
        const vectors& photon_normals() const
        {
            return s.leaks.needs_photon_normals() ? map->photons.normals : map->photons.positions;
        }
        /// Params::leaks of photon_distance.glsl.
        glm::vec4 leaks() const
        {
            return {s.leaks.min_cosine, s.leaks.flattening * s.leaks.flattening - 1.0f, 0.0f, 0.0f};
        }
        /// The SWITCHes of kernel K for this search's policies.
        template <class K>
        uint policies() const
        {
            return policy_switches<K>(s.leaks);
        }
        /// The SWITCH of kernel K for block maps.
        template <class K>
        uint blocks() const
        {
            return map->has_blocks() ? K::BLOCKS_switch : 0u;
        }
        /// The SWITCHes of kernel K for this search's policies and for the kind of its map.
        template <class K>
        uint map_switches() const
        {
            return policies<K>() | blocks<K>();
        }
        /// The SWITCH of kernel K for points with half spaces.
        template <class K>
        uint halved() const
        {
            return s.half_spaces ? K::HALVED_switch : 0u;
        }
        /// The SWITCH of kernel K for maps that may hold a photon several times.
        template <class K>
        uint repeats() const
        {
            return map->may_repeat() ? K::REPEATS_switch : 0u;
        }
        /// The SWITCH of kernel K that turns subgroup search on.
        template <class K>
        uint together() const
        {
            return are_close(s, *map, points->size()) ? 1u << K::group_switch : 0u;
        }
    };
    /// Runs stages in order, at most `passes` passes in total: `run(left)` runs up to `left` passes of the current
    /// stage, `next()` starts the stage after one that has finished, and `finished()` says whether all have finished.
    template <class Finished, class Run, class Next>
    progress run_stages(uint passes, Finished finished, Run run, Next next)
    {
        progress all;
        while (!finished() && all.passes < passes) {
            const progress p = run(passes - all.passes);
            all.passes += p.passes;
            all.active.insert(all.active.end(), p.active.begin(), p.active.end());
            if (!p.finished)
                break;
            next();
        }
        all.finished = finished();
        return all;
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
