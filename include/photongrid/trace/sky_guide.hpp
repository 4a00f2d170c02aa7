// A guide to the sky: in which directions it is seen from the surfaces that a camera sees. In a room with a window
// nearly all shadow rays to the sky end at the walls; with the guide most go through the window. It is learned from
// shadow rays in all directions, at some thousand points, in cells of points that are near each other and have like
// normals (Müller, Gross and Novák, Practical Path Guiding, 2017, learn such tables from paths).
#pragma once

#include <photongrid/scene/distant_lights.hpp>
#include <photongrid/trace/eye_rays.hpp>
#include <photongrid/trace/sky_bins.kernel.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace detail {
    /// A point at which the sky is looked at.
    struct sky_point {
        std::array<float, 6> at{};  ///< position, m, and normal
        float seen = 0;             ///< share of the samples by the environment's light that arrive
        uint pixel = 0;             ///< element of its eye ray
        std::vector<float> looks{}; ///< the light that each of SKY_LOOKS finds
    };

    /// A tree of cells of points, and what is seen from each; see sky_guide.glsl.
    class sky_cells {
    public:
        /// `points`: at least one, which it sorts. They must outlive it.
        explicit sky_cells(std::span<sky_point> points)
        {
            float size = 0;
            for (std::size_t axis = 0; axis < 3; ++axis)
                size = std::max(size, width(axis, points));
            unit_ = std::max(size / 8, 1e-30f);
            split(1, points);
        }
        /// Whether few samples by the environment's light arrive in some cell.
        bool are_wanted() const
        {
            return std::any_of(cells_.begin(), cells_.end(), [](auto cell) { return is_wanted(cell); });
        }
        /// The guide for kernels.
        std::vector<glm::vec4> table() const
        {
            std::vector<glm::vec4> out(nodes_.begin() + 1, nodes_.end());
            for (const auto cell : cells_) {
                auto shares = is_wanted(cell) ? shares_of(cell) : std::vector<float>{};
                out.emplace_back(shares.empty() ? 0.0f : 1.0f, 0.0f, 0.0f, 0.0f);
                shares.resize(kernels::SKY_BINS);
                for (std::size_t i = 0; i < shares.size(); i += 4)
                    out.emplace_back(shares[i], shares[i + 1], shares[i + 2], shares[i + 3]);
            }
            return out;
        }

    private:
        using some = std::span<sky_point>;

        static float width(std::size_t axis, some points)
        {
            const auto [least, most] = std::minmax_element(
                points.begin(), points.end(), [&](auto& a, auto& b) { return a.at[axis] < b.at[axis]; });
            return most->at[axis] - least->at[axis];
        }
        void split(std::size_t node, some points)
        {
            if (node >= kernels::SKY_CELLS) {
                cells_[node - kernels::SKY_CELLS] = points;
                return;
            }
            std::size_t axis = 0;
            float widest = -1;
            for (std::size_t a = 0; a < 6; ++a)
                if (const float wide = width(a, points) / (a < 3 ? unit_ : 1); wide > widest) {
                    widest = wide;
                    axis = a;
                }
            // A stable order, so that all standard libraries make the same cells.
            std::stable_sort(points.begin(), points.end(), [&](auto& a, auto& b) { return a.at[axis] < b.at[axis]; });
            const auto size_below = [&](float x) {
                const auto end = std::find_if(points.begin(), points.end(), [&](auto& p) { return p.at[axis] >= x; });
                return static_cast<std::size_t>(end - points.begin());
            };
            float border = points[points.size() / 2].at[axis];
            if (size_below(border) == 0)
                border = std::nextafter(border, std::numeric_limits<float>::infinity());
            const auto below = size_below(border);
            nodes_[node] = {static_cast<float>(axis), border, 0.0f, 0.0f};
            split(2 * node, points.first(below));
            split(2 * node + 1, below < points.size() ? points.subspan(below) : points); // where all are the same
        }
        static bool is_wanted(some cell)
        {
            double seen = 0;
            for (const auto& p : cell)
                seen += static_cast<double>(p.seen);
            return seen < 0.2 * static_cast<double>(cell.size());
        }
        /// Of a cell's samples, those in the bins up to each; empty if nothing is seen. In proportion to the root of
        /// the mean square of the light: from each point other directions of a bin are blocked.
        static std::vector<float> shares_of(some cell)
        {
            struct bin {
                double squares = 0, looks = 0;
            };
            std::vector<bin> bins(kernels::SKY_BINS);
            for (const auto& p : cell)
                for (uint look = 0; look < p.looks.size(); ++look) {
                    auto& b = bins[kernels::sky_bin_of_look(look, p.pixel)];
                    b.squares += static_cast<double>(p.looks[look]) * static_cast<double>(p.looks[look]);
                    ++b.looks;
                }
            // Each with the eight bins around it, which together count as much: the edge of what is seen may be there.
            std::vector<double> weights;
            double all = 0;
            constexpr uint side = kernels::SKY_SIDE;
            for (uint at = 0; at < kernels::SKY_BINS; ++at) {
                const uint row = at / side, column = at % side;
                bin sum;
                for (uint y = std::max(row, 1u) - 1; y < std::min(row + 2, side); ++y)
                    for (const uint x : {column + side - 1, column, column + 1}) {
                        const auto& b = bins[y * side + x % side];
                        const double share = y == row && x == column ? 8 : 1;
                        sum.squares += share * b.squares;
                        sum.looks += share * b.looks;
                    }
                weights.push_back(sum.looks > 0 ? std::sqrt(sum.squares / sum.looks) : 0.0);
                all += weights.back();
            }
            if (!(all > 0))
                return {};
            std::vector<std::uint32_t> counts;
            append_shares(counts, weights);
            std::vector<float> shares;
            for (const auto n : counts)
                shares.push_back(static_cast<float>(n) * 0x1p-24f);
            return shares;
        }

        float unit_ = 1; // m; points so far apart differ as much as those with normals 60 degrees apart
        std::array<glm::vec4, kernels::SKY_CELLS> nodes_{}; // 0 is not used
        std::array<some, kernels::SKY_CELLS> cells_{};
    };

    /// The number of the environment among the lights, if there is one.
    inline std::optional<uint> number_of_environment(const scene_layout& layout)
    {
        const auto lights = layout.table(kernels::LIGHT_TABLE);
        for (uint i = 0; i < lights.count; ++i)
            if (layout.records[lights.first + lights.stride * i].x == light_kind<environment_light>::number)
                return i;
        return {};
    }
} // namespace detail

/// The guide for what a camera sees in a scene, as sky_guide.glsl reads it: empty if shadow rays need none. `aspect`:
/// width of the picture over its height.
/// \throws backend_error.
template <backend B>
std::vector<glm::vec4> learn_sky(B& device, const device_scene<B>& s, const camera& view, double aspect)
{
    const auto number = detail::number_of_environment(s.layout);
    if (!number)
        return {};
    constexpr uint pixels = 2304, rays = 16;
    render_settings settings;
    settings.view.spp = 1;
    settings.output.passes = 1;
    settings.output.width = static_cast<uint>(std::clamp(std::round(std::sqrt(pixels * aspect)), 1.0, 1.0 * pixels));
    settings.output.height = pixels / settings.output.width;
    const auto raster = detail::raster_of(settings, 1);
    const auto n = raster.size();
    detail::eye_hits<B> hits(device, n);
    auto branches = device.template make<uint>(n);
    detail::trace_eye_rays(device, s, {view, raster}, {settings, 0, launch(n, 0)}, hits, branches);

    auto light = device.template make<glm::vec4>(n);
    const detail::lit_points<B> lit{hits.points, hits.surfaces};
    const auto lit_by = [&](uint nth, uint sky) {
        device.template run<kernels::zero_vectors>(n, {}, reads(), writes(light));
        const uint ray = nth << detail::splits_of(s.layout);
        detail::add_light_samples(device, s, {{.light = *number, .seed = 0x5C4F1D27u, .sky = sky}},
            {settings, ray, launch(n, 0)}, lit, light, [](const auto&, auto&) {});
        return device.download(light);
    };
    const auto positions = device.download(hits.points), normals = device.download(hits.surfaces);
    std::vector<detail::sky_point> points;
    for (uint i = 0; i < n; ++i)
        if (const auto& p = positions[i], &m = normals[i]; p.w > 0)
            points.push_back({.at = {p.x, p.y, p.z, m.x, m.y, m.z}, .pixel = i});
    if (points.empty())
        return {};
    const auto brightness = [](const glm::vec4& v) { return v.x + v.y + v.z; };
    for (uint nth = 0; nth < rays; ++nth) {
        const auto arrives = lit_by(nth, 0);
        for (auto& p : points)
            p.seen += brightness(arrives[p.pixel]) > 0 ? 1.0f / rays : 0.0f;
    }
    if (auto some = points; !detail::sky_cells(some).are_wanted())
        return {};
    for (uint look = 0; look < kernels::SKY_LOOKS; ++look) {
        const auto arrives = lit_by(look, 2 + look);
        for (auto& p : points)
            p.looks.push_back(brightness(arrives[p.pixel]));
    }
    return detail::sky_cells(points).table();
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
