// Edge correction of density estimates: each is divided by the share of its filter's mass that lies on the surface
// ("cut and normalise", Gasser and Müller 1979; Diggle, Applied Statistics 34(2), 1985). Without it an estimate at a
// straight edge is half of the irradiance, in a right corner a quarter.
#pragma once

#include <photongrid/core/zero_vectors.kernel.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/render/correct_bias.kernel.hpp>
#include <photongrid/render/covered_moments.kernel.hpp>
#include <photongrid/render/covered_share.kernel.hpp>
#include <photongrid/render/divide_by_share.kernel.hpp>
#include <photongrid/trace/device_scene.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace detail {
    /// A range of consecutive polygon records.
    struct polygon_range {
        uint first = 0; ///< record
        uint polygons = 0;
    };

    /// A scene's polygons, including lamps, in ranges that one pass can process: some drivers end loops silently after
    /// 65,535 iterations, counted over up to 16 lanes.
    /// \throws std::invalid_argument for a polygon with too many vertices for one pass.
    inline std::vector<polygon_range> ranges_of_polygons(const scene_layout& s)
    {
        constexpr uint per_pass = 4000;
        std::vector<polygon_range> ranges;
        const auto polygons = s.table(shape_kind<polygon>::number);
        uint at = polygons.first, left = 0;
        for (uint i = 0; i < polygons.count; ++i) {
            const uint edges = static_cast<uint>(s.records[at + 1].x);
            const uint work = 1 + 2 * edges;
            if (work > per_pass)
                throw std::invalid_argument("edge_correction: polygons[" + std::to_string(i) + "] has "
                    + std::to_string(edges) + " vertices; at most " + std::to_string((per_pass - 1) / 2)
                    + " can be corrected, so split it");
            if (work > left) {
                ranges.push_back({at, 0});
                left = per_pass;
            }
            left -= work;
            ++ranges.back().polygons;
            at += 2 + 2 * edges;
        }
        return ranges;
    }
} // namespace detail

/// The discs of estimates: the filter over them, and the least radius of the search's settings, m.
struct disc_kind {
    filter_kind filter;
    float min_radius = 0;

    disc_kind(filter_kind filter_, float min_radius_ = 0) : filter(filter_), min_radius(min_radius_) {}
};

/// x: the share, 0 to about 1, of each estimate's disc that lies on polygons of the scene, weighted by the filter. y: 1
/// for points on a polygon, 0 for others, whose share has no meaning. Polygons in one plane are one surface, whichever
/// way they are wound; where they overlap they count twice. Mirrors, glass and lamps hold no photons and do not count.
/// Polygons of lamps and mirrors in front of the surface, nearer to it than a quarter of the radius, hide it: their
/// share is subtracted.
///
/// `points` (recentred, m; w > 0: has an estimate), `normals` (unit) and `irradiances` (w: squared radius, m^2) are
/// those of the estimate. The error is about 1e-6, plus 2^-22 of the scene's
/// size relative to the radius.
/// \throws std::invalid_argument for a polygon of more than 1,999 vertices.
template <backend B>
buffer_of<B, glm::vec4> covered_shares(B& device, const device_scene<B>& s, const buffer_of<B, glm::vec4>& points,
    const buffer_of<B, glm::vec4>& normals, const buffer_of<B, glm::vec4>& irradiances, const disc_kind& disc)
{
    const auto n = points.size();
    auto cover = device.template make<glm::vec4>(n);
    device.template run<kernels::zero_vectors>(n, {}, reads(), writes(cover));
    for (const auto& range : detail::ranges_of_polygons(s.layout))
        device.template run<kernels::covered_share>({n, 0u, detail::filter_switch(disc.filter)},
            {.min_radius2 = detail::min_radius2(disc.min_radius), .first = range.first, .polygons = range.polygons},
            reads(s.records, points, normals, irradiances), writes(cover));
    return cover;
}

/// Moments of the part of each estimate's disc that lies on polygons of the scene, over that of the whole disc. Axes:
/// basis_about(normal); lengths are divided by the radius.
template <backend B>
struct disc_moments {
    buffer_of<B, glm::vec4> shares;  ///< x: by the constant filter; y: Epanechnikov's; zw: first moment, the estimate's
    buffer_of<B, glm::vec4> firsts;  ///< xy: first moment by the constant filter; zw: Epanechnikov's
    buffer_of<B, glm::vec4> seconds; ///< xyz: second moments uu, uv, vv by the constant filter
};

/// Arguments, errors and what counts are those of covered_shares.
template <backend B>
disc_moments<B> covered_moments(B& device, const device_scene<B>& s, const buffer_of<B, glm::vec4>& points,
    const buffer_of<B, glm::vec4>& normals, const buffer_of<B, glm::vec4>& irradiances, const disc_kind& disc)
{
    const auto n = points.size();
    disc_moments<B> m;
    for (auto* buffer : {&m.shares, &m.firsts, &m.seconds}) {
        *buffer = device.template make<glm::vec4>(n);
        device.template run<kernels::zero_vectors>(n, {}, reads(), writes(*buffer));
    }
    for (const auto& range : detail::ranges_of_polygons(s.layout))
        device.template run<kernels::covered_moments>({n, 0u, detail::filter_switch(disc.filter)},
            {.min_radius2 = detail::min_radius2(disc.min_radius), .first = range.first, .polygons = range.polygons},
            reads(s.records, points, normals, irradiances), writes(m.shares, m.firsts, m.seconds));
    return m;
}

/// Corrects estimates, and their standard errors and biases if there are any, at points on polygons. Shares below 2^-8
/// (a corner of 1.4 degrees) count as 2^-8. The search must reject photons of adjoining surfaces
/// (leak_policy::min_cosine), so that all photons lie on the corrected surface. Radius and counts do not change.
/// \throws std::invalid_argument as covered_shares does.
/// \snippet snippets.cpp correct_edges
template <backend B>
void correct_edges(B& device, const device_scene<B>& s, const buffer_of<B, glm::vec4>& points,
    const buffer_of<B, glm::vec4>& normals, knn_estimates<B>& estimates, const disc_kind& disc)
{
    constexpr float least = 0x1p-8f;
    const auto cover = covered_shares(device, s, points, normals, estimates.irradiance, disc);
    device.template run<kernels::divide_by_share>(
        estimates.irradiance.size(), {.least = least, .keeps_w = 1u}, reads(cover), writes(estimates.irradiance));
    device.template run<kernels::divide_by_share>(estimates.standard_error.size(), {.least = least, .keeps_w = 0u},
        reads(cover), writes(estimates.standard_error));
    auto& b = estimates.biases;
    if (b.bias.size() == 0)
        return;
    const auto m = covered_moments(device, s, points, normals, estimates.irradiance, disc);
    device.template run<kernels::correct_bias>(b.bias.size(),
        {.factor = detail::bias_factor(disc.filter), .least = least},
        reads(cover, m.shares, m.firsts, m.seconds, b.constant, normals), writes(b.bias, b.tilt, b.jump));
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
