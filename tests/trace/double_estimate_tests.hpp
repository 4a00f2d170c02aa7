// Estimates in double.
#pragma once

#include "double_kernels.hpp"

namespace photongrid::testing {

/// The estimating kernels in double over photons binned in double; the k nearest photons are found by sorting all.
class double_estimates {
public:
    /// What one point's estimate is.
    struct estimate {
        std::vector<uint>
            ids; ///< the k nearest in double, the k-th last; none where fewer than k are left by the policies
        glm::dvec4 irradiance{0}, standard_error{0};
        double unweighted = 0;   ///< the first channel's irradiance if every photon had weight 1
        double conditioning = 0; ///< sum of w p^2 over sum of w^2 p^2, of the photons' first channels p
    };

    double_estimates(const oriented_set& s, const knn_settings& settings, float min_radius)
        : settings_(settings), points_(widened(s.points)), normals_(widened(s.point_normals)),
          min_radius2_(static_cast<double>(min_radius) * static_cast<double>(min_radius))
    {
        const auto g = widened(s.photons.g);
        std::vector<std::pair<uint, uint>> order; // cell, id
        for (uint id = 0; id < s.photons.positions.size(); ++id) {
            const auto c = double_kernels::cell_coordinates(g, glm::dvec4(s.photons.positions[id]));
            order.emplace_back(double_kernels::cell_number(g, c.x, c.y, c.z), id);
        }
        std::sort(order.begin(), order.end());
        cells_.assign(g.resolution.w, uvec2(0));
        for (const auto& [cell, id] : order) {
            ++cells_[cell].y;
            list_.push_back(id);
            positions_.emplace_back(s.photons.positions[id]);
            powers_.emplace_back(s.photons.powers[id]);
            directions_.emplace_back(s.directions[id]);
        }
        for (std::size_t c = 1; c < cells_.size(); ++c)
            cells_[c].x = cells_[c - 1].x + cells_[c - 1].y;

        gather_.args.grid = g;
        gather_.args.leaks = glm::dvec4(-1.0,
            static_cast<double>(settings.leaks.flattening) * static_cast<double>(settings.leaks.flattening) - 1, 0, 0);
        gather_.args.min_radius2 = min_radius2_;
        gather_.args.visits = settings.visits_per_pass;
        gather_.args.ranges = settings.ranges_per_pass;
        using K = double_kernels::gather_photons;
        turn_switches(gather_,
            (settings.leaks.side ? K::SIDE_switch : 0u) | (settings.leaks.flattening > 1 ? K::FLATTEN_switch : 0u)
                | detail::filter_switch(settings.filter) | K::LEAVE_OUT_switch | K::ERRORS_switch);
        gather_.points_data = points_;
        gather_.normals_data = normals_;
        gather_.cells_data = cells_;
        gather_.positions_data = positions_;
        gather_.directions_data = directions_;
        gather_.photon_normals_data = directions_;
        gather_.list_data = list_;
        gather_.powers_data = powers_;
    }

    estimate operator()(uint q)
    {
        std::vector<std::pair<double, uint>> near; // squared distance, index
        for (uint at = 0; at < list_.size(); ++at)
            if (const double d2 = gather_.photon_distance2(at, points_[q], normals_[q]); d2 < 1e30)
                near.emplace_back(d2, at);
        estimate e;
        if (near.size() < settings_.k)
            return e;
        std::nth_element(near.begin(), near.begin() + (settings_.k - 1), near.end());
        const double radius2 = near[settings_.k - 1].first;
        double square = 0, linear = 0;
        for (uint j = 0; j < settings_.k; ++j) {
            e.ids.push_back(list_[near[j].second]);
            if (j + 1 == settings_.k)
                continue;
            const double p = powers_[near[j].second].x, t = near[j].first / radius2;
            const double w[] = {1, 1 - std::sqrt(t), 1 - t, (1 - t) * (1 - t)};
            const double weight = w[static_cast<int>(settings_.filter)];
            e.unweighted += p;
            linear += weight * p * p;
            square += weight * weight * p * p;
        }
        constexpr double norms[] = {1, 3, 2, 3};
        const double norm = norms[static_cast<int>(settings_.filter)];
        e.unweighted *= norm / (M_PI * std::max(radius2, min_radius2_));
        e.conditioning = linear / square;

        const std::vector<glm::dvec4> radius(1, glm::dvec4(radius2, 1, 0, 0)), one_point(1, points_[q]);
        const std::vector<glm::uvec4> chosen(1, glm::uvec4(settings_.k, 0u, 0xFFFFFFFFu, 0u));
        double_kernels::gather_start start;
        start.args.searching = 1;
        start.points_data = one_point;
        start.chosen_data = chosen;
        start.kernel(0);
        gather_.search_radius = radius[0];
        gather_.chosen = chosen[0];
        gather_.sum = start.sum;
        gather_.compensation = start.compensation;
        gather_.squares = start.squares;
        gather_.cursor = start.cursor;
        gather_.tally = start.tally;
        while (!gather_.done())
            gather_.kernel(q);
        const std::vector<glm::dvec4> sums(1, gather_.sum), squares(1, gather_.squares);
        const std::vector<glm::uvec4> tallies(1, gather_.tally);
        double_kernels::irradiance_estimate result;
        result.args.norm = norm;
        result.args.min_radius2 = min_radius2_;
        result.args.leave_out = 1;
        result.points_data = one_point;
        result.search_radii_data = radius;
        result.sums_data = sums;
        result.squares_data = squares;
        result.tallies_data = tallies;
        result.kernel(0);
        constexpr double pi = static_cast<double>(3.14159265f) / M_PI; // the kernel's constant stays a float
        e.irradiance = result.irradiance * pi;
        e.standard_error = result.standard_error * pi;
        return e;
    }

private:
    knn_settings settings_;
    std::vector<glm::dvec4> points_, normals_, positions_, powers_, directions_;
    std::vector<uvec2> cells_;
    std::vector<uint> list_;
    double min_radius2_;
    double_kernels::gather_photons gather_;
};

/// Photons and points on the faces of a box.
inline oriented_set photons_on_a_box()
{
    auto s = make_oriented(distribution::box_faces, 20000, {12, 12, 12}, 0, 71);
    random_source u(72);
    for (int i = 0; i < 1000; ++i) {
        glm::vec3 p(u(), u(), u());
        const int axis = static_cast<int>(u.below(3));
        const float side = u() < 0.5f ? 0.0f : 1.0f;
        p[axis] = side;
        s.points.emplace_back(p, 1.0f);
        glm::vec3 n(0);
        n[axis] = 1 - 2 * side;
        s.point_normals.emplace_back(n, 0.0f);
    }
    return s;
}

/// Whether the photons within a squared radius, found in float, are those found in double, the k-th last. The k-th and
/// its neighbour may have changed places or become one distance in float, so that another is left out; or a photon that
/// grazes the surface has changed its side.
inline bool has_photons(
    const oriented_set& s, uint point, float radius2, const leak_policy& leaks, const std::vector<uint>& in_double)
{
    std::vector<uint> ids;
    uint at_the_radius = 0;
    for (uint id = 0; id < s.photons.positions.size(); ++id)
        if (const auto d2 = policy_distance2(s, point, id, leaks); d2 && *d2 <= radius2) {
            ids.push_back(id);
            at_the_radius += *d2 == radius2 ? 1u : 0u;
        }
    auto expected = in_double;
    std::sort(expected.begin(), expected.end());
    return expected == ids && at_the_radius == 1 && *policy_distance2(s, point, in_double.back(), leaks) == radius2;
}

/// How much rounding may change an estimate, in units of 2^-24.
class rounding_limits {
public:
    rounding_limits(filter_kind filter, const leak_policy& leaks)
    {
        // A squared distance: 2 for each difference, 1 for its square, 2 for the sum; flattened, up to 18.
        // t = d^2 / r^2: two of them, and 2. A weight's error is that times its slope, and what rounds in it: cone 1
        // for the root (its slope times t is at most 1/2) and 1, Epanechnikov 1, Silverman twice that and 1.
        const double distance = leaks.flattening > 1 ? 18 : 5, t = 2 * distance + 2;
        weight_ = filter == filter_kind::constant ? 0
            : filter == filter_kind::cone         ? 0.5 * t + 2
            : filter == filter_kind::epanechnikov ? t + 1
                                                  : 2 * (t + 1) + 1;
        // The rest: the disc, 3.14159265f, two products, a quotient, the weighted power, and 2 for a compensated sum.
        rest_ = distance + 0.5 + 3 + 1 + 2;
    }
    double irradiance(const double_estimates::estimate& exact) const
    {
        return rest_ * exact.irradiance.x + weight_ * exact.unweighted;
    }
    double relative_standard_error(const double_estimates::estimate& exact, uint k) const
    {
        // Half the error of the variance, whose k - 2 plain additions round k - 2 times; 3 in each square, 3 in its
        // factor.
        return rest_ + 1 + weight_ * exact.conditioning + 0.5 * (k - 2 + 6);
    }

private:
    double weight_ = 0, rest_ = 0;
};

TEST(double_oracle, estimates)
{
    const auto s = photons_on_a_box();
    serial_backend b;
    const auto map = sorted_map(b, upload_photons(b, s), s.photons.g);
    const auto points = b.upload(std::span<const vec4>(s.points)),
               normals = b.upload(std::span<const vec4>(s.point_normals));
    struct row {
        const char* name;
        filter_kind filter;
        leak_policy leaks;
        uint k;
    };
    const leak_policy strict{.side = true, .flattening = 3};
    const row rows[] = {{"constant, k = 50", filter_kind::constant, {}, 50},
        {"cone, k = 50", filter_kind::cone, {}, 50}, {"Epanechnikov, k = 50", filter_kind::epanechnikov, {}, 50},
        {"Silverman, k = 50", filter_kind::silverman, {}, 50}, {"constant, k = 1000", filter_kind::constant, {}, 1000},
        {"Silverman, k = 1000", filter_kind::silverman, {}, 1000},
        {"Silverman, k = 50, side, flattened 3 times", filter_kind::silverman, strict, 50}};
    std::size_t other = 0, compared = 0;
    for (const auto& r : rows) {
        knn_settings k{.k = r.k, .max_radius = 10, .min_radius = 1e-6f};
        k.filter = r.filter;
        k.leaks = r.leaks;
        k.errors = true;
        const auto e = knn_grid_estimate(b, map, points, normals, k);
        const auto irradiance = b.download(e.irradiance), standard_error = b.download(e.standard_error);
        double_estimates wide(s, k, k.min_radius);
        const rounding_limits limits(r.filter, r.leaks);
        std::vector<double> errors, spread_errors;
        double nearest_limit = 0, nearest_spread_limit = 0;
        for (uint q = 0; q < s.points.size(); ++q) {
            const auto exact = wide(q);
            ++compared;
            if (!has_photons(s, q, irradiance[q].w, r.leaks, exact.ids)) {
                ++other;
                continue;
            }
            const double error = std::abs(static_cast<double>(irradiance[q].x) - exact.irradiance.x);
            nearest_limit = std::max(nearest_limit, error * 0x1p24 / limits.irradiance(exact));
            errors.push_back(error / exact.irradiance.x);
            const double spread_error = std::abs(static_cast<double>(standard_error[q].x) / exact.standard_error.x - 1);
            nearest_spread_limit
                = std::max(nearest_spread_limit, spread_error * 0x1p24 / limits.relative_standard_error(exact, r.k));
            spread_errors.push_back(spread_error);
        }
        ASSERT_FALSE(errors.empty()) << r.name << ": no point has the photons it should";
        report_errors((std::string("relative error of irradiance, ") + r.name).c_str(), errors);
        report_errors((std::string("relative error of its standard error, ") + r.name).c_str(), spread_errors);
        std::printf(
            "double oracle: %s: at most %.2g and %.2g of the limits\n", r.name, nearest_limit, nearest_spread_limit);
        EXPECT_LE(nearest_limit, 1) << r.name;
        EXPECT_LE(nearest_spread_limit, 1) << r.name;
    }
    std::printf("double oracle: %zu of %zu points have other photons among the k nearest\n", other, compared);
    EXPECT_LE(other, compared / 500);
}

} // namespace photongrid::testing
