// The fixture of tests of estimates on any backend: brute force in double, all that can be chosen.
#pragma once

#include "../backends/serial_algorithms.hpp"
#include "../core/under_test.hpp"
#include "../map/photon_sets.hpp"
#include "known_answers.hpp"

#include <photongrid/estimate/knn_grid_estimate.hpp>

#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace photongrid::testing {

using glm::uvec2;
using glm::uvec3;
using glm::vec4;

inline constexpr search_kind all_searches[]
    = {search_kind::at_least_k, search_kind::exact_k, search_kind::fixed_radius};
inline constexpr bias_kind all_biases[] = {bias_kind::paper, bias_kind::unbiased};
inline const leak_policy all_policies[] = {{}, {.side = true}, {.min_cosine = 0.3f}, {.flattening = 3},
    {.side = true, .min_cosine = -0.5f, .flattening = 1.5f}};

template <backend B>
photons<B> upload_photons(B& b, const oriented_set& s)
{
    auto p = upload_photons(b, s.photons);
    p.directions = b.upload(std::span<const vec4>(s.directions));
    p.normals = b.upload(std::span<const vec4>(s.normals));
    return p;
}

template <class Tag>
class estimators : public on_backend<Tag> {
protected:
    using B = typename Tag::type;

    /// A map, and what brute force has to know of it.
    struct known_map {
        map_buffers<B> map;
        std::vector<uint> ids;    ///< of the photons in the map
        std::vector<vec4> powers; ///< by id: routing has changed them
    };
    known_map known(const oriented_set& s, map_kind kind)
    {
        auto& b = this->b();
        known_map m{make_map(b, kind, upload_photons(b, s), s.photons.g, 3, 5), {},
            std::vector<vec4>(s.photons.positions.size())};
        const auto stored = b.download(m.map.photons.powers);
        for (const auto& ids : ids_in(b, m.map))
            for (const uint id : ids) {
                m.powers[id] = stored[m.ids.size()];
                m.ids.push_back(id);
            }
        return m;
    }

    /// Runs one search over a map of `s` and compares every point with brute force; returns what differs, or nothing.
    std::string difference(const oriented_set& s, const known_map& m, knn_settings settings)
    {
        auto& b = this->b();
        // Errors always, but for the paper's own estimate, which has a path of its own without them.
        settings.errors = settings.search != search_kind::at_least_k || settings.filter != filter_kind::constant
            || settings.bias != bias_kind::paper;
        settings.biases = settings.errors && compares_biases_;
        const auto points = b.upload(std::span<const vec4>(s.points));
        const auto normals = b.upload(std::span<const vec4>(s.point_normals));
        const auto e = knn_grid_estimate(b, m.map, points, normals, settings);
        const auto irradiance = b.download(e.irradiance);
        const auto used = b.download(e.used);
        const auto standard_error = b.download(e.standard_error);
        const auto reported = biases_of(e);
        for (std::size_t q = 0; q < s.points.size(); ++q) {
            auto own = settings;
            if (settings.radii_at_points) // all are powers of two
                own.max_radius = std::min(std::sqrt(s.points[q].w), settings.max_radius);
            const auto expected = estimate_by_force(
                s, m.ids, m.powers, q, own, m.map.has_blocks() ? std::optional<float>() : irradiance[q].w);
            const auto where = " at point " + std::to_string(q);
            if (used[q].x != expected.ids.size())
                return "used " + std::to_string(used[q].x) + ", not " + std::to_string(expected.ids.size()) + where;
            if (static_cast<double>(irradiance[q].w) != expected.radius2)
                return "squared radius " + std::to_string(irradiance[q].w) + ", not " + std::to_string(expected.radius2)
                    + where;
            // The sum is zero or tells the set: powers are random.
            for (int c = 0; c < 3; ++c) {
                const double error = std::abs(static_cast<double>(irradiance[q][c]) - expected.irradiance[c]);
                if (!(error <= 4e-6 * expected.irradiance[c] + 1e-6 * expected.irradiance.x))
                    return "channel " + std::to_string(c) + " is " + std::to_string(irradiance[q][c]) + ", not "
                        + std::to_string(expected.irradiance[c]) + where;
                if (error > 0)
                    largest_error_ = std::max(largest_error_, error / expected.irradiance[c]);
            }
            for (int c = 0; settings.errors && c < 4; ++c)
                if (!(std::abs(static_cast<double>(standard_error[q][c]) - expected.standard_error[c])
                        <= 4e-6 * expected.standard_error[c] + 1e-6 * expected.irradiance.x))
                    return "standard error " + std::to_string(c) + " is " + std::to_string(standard_error[q][c])
                        + ", not " + std::to_string(expected.standard_error[c]) + where;
            if (settings.biases)
                if (const auto wrong = other_biases(reported, q, expected); !wrong.empty())
                    return wrong + where;
        }
        return {};
    }

    /// Off where photons are so close to points that the weights of moments, r / |d|, round badly.
    bool compares_biases_ = true;

    /// Biases, downloaded.
    struct biases_found {
        std::vector<vec4> bias, tilt, jump, constant;
    };
    biases_found biases_of(const knn_estimates<B>& e)
    {
        auto& b = this->b();
        return {b.download(e.biases.bias), b.download(e.biases.tilt), b.download(e.biases.jump),
            b.download(e.biases.constant)};
    }
    /// What differs between the biases of a point and what brute force finds, or nothing. Their sums have terms of
    /// either sign.
    static std::string other_biases(const biases_found& reported, std::size_t q, const brute_estimate& expected)
    {
        const double all = std::max({expected.constant.x, expected.constant.y, expected.constant.z});
        const auto differ = [&](const char* name, const vec4& found, const glm::dvec3& known) {
            for (int c = 0; c < 3; ++c)
                if (!(std::abs(static_cast<double>(found[c]) - known[c]) <= 1e-5 * all))
                    return std::string(name) + " " + std::to_string(c) + " is " + std::to_string(found[c]) + ", not "
                        + std::to_string(known[c]);
            return std::string();
        };
        for (const auto& wrong : {differ("bias", reported.bias[q], expected.bias),
                 differ("tilt", reported.tilt[q], expected.tilt), differ("jump", reported.jump[q], expected.jump),
                 differ("constant", reported.constant[q], expected.constant)})
            if (!wrong.empty())
                return wrong;
        return {};
    }

    /// Which point has another radius, other photons or another sum of their powers, which are whole numbers, than
    /// brute force finds for exact_k and at_least_k, or nothing.
    std::string other_photons(
        const photon_set& s, const map_buffers<B>& map, const std::vector<vec4>& points, const knn_settings& k)
    {
        auto& b = this->b();
        const auto in_cells = ids_in(b, map);
        const auto e = knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)), k);
        const auto irradiance = b.download(e.irradiance);
        const auto used = b.download(e.used);
        const float max2 = std::min(k.max_radius * k.max_radius, 1e38f);
        for (std::size_t q = 0; q < points.size(); ++q) {
            std::vector<std::pair<float, uint>> near;
            if (k.max_radius > 0 && std::isfinite(points[q].x) && std::isfinite(points[q].y)
                && std::isfinite(points[q].z))
                for (uint id = 0; id < s.positions.size(); ++id)
                    if (const float d2 = distance2(s.positions[id], points[q]);
                        d2 <= max2 && std::isfinite(d2) && std::isfinite(s.powers[id].z))
                        near.emplace_back(d2, id);
            std::sort(near.begin(), near.end());
            float radius2 = max2;
            const bool is_by_photon = near.size() >= k.k;
            if (is_by_photon) {
                radius2 = k.search == search_kind::exact_k ? near[k.k - 1].first
                    : map.has_blocks()                     ? radius2_in_blocks(near[k.k - 1].first, max2)
                                                           : grown_by_force(s.positions, s.g, in_cells, points[q], k);
                std::erase_if(near, [&](const auto& n) { return n.first > radius2; });
                if (k.search == search_kind::exact_k)
                    near.resize(k.k);
            }
            const auto where = " at point " + std::to_string(q);
            if (irradiance[q].w != radius2)
                return "squared radius " + std::to_string(irradiance[q].w) + ", not " + std::to_string(radius2) + where;
            if (used[q].x != near.size())
                return "used " + std::to_string(used[q].x) + ", not " + std::to_string(near.size()) + where;
            const double min2 = least_disc2(points[q], k.min_radius),
                         disc = M_PI * std::max(static_cast<double>(radius2), min2);
            if (is_by_photon && !(map.has_blocks() && k.search == search_kind::at_least_k)
                && k.bias == bias_kind::unbiased && static_cast<double>(radius2) >= min2)
                near.pop_back();
            glm::dvec3 sum(0);
            for (const auto& n : near)
                sum += glm::dvec3(s.powers[n.second]);
            for (int c = 0; c < 3 && disc < 1e30; ++c) // beyond, some devices round the irradiance to 0
                if (const double found = static_cast<double>(irradiance[q][c]) * disc; std::abs(found - sum[c]) > 0.25)
                    return "powers add up to " + std::to_string(found) + ", not " + std::to_string(sum[c]) + where;
        }
        return {};
    }

    double largest_error_ = 0; ///< of irradiance, relative, so far
};
TYPED_TEST_SUITE_P(estimators);

} // namespace photongrid::testing
