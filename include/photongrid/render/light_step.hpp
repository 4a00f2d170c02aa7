// What an estimate sees of a straight step of the light within its disc (docs/design/decisions.md, "The bias is
// estimated").
#pragma once

#include <photongrid/estimate/filter.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// Of light that is 1 beyond a straight line and 0 before it, at the middle of a disc of radius 1 before the line.
struct light_step {
    double tilt = 0;  ///< first moment of the light over the disc
    double jump = 0;  ///< the same with jump_weight (bias_weights.glsl)
    double curve = 0; ///< estimate by the constant filter less that by Epanechnikov's
    double bias = 0;  ///< estimate by the filter: there is no light at the middle
};

/// The line is at the distance x from the middle, 0 to 1. Integrals over the segment of the disc beyond it.
inline light_step step_at(double x, filter_kind filter)
{
    constexpr double pi = 3.14159265358979324;
    const double s = std::sqrt(std::max(1 - x * x, 0.0)), angle = std::acos(std::min(x, 1.0));
    const double log = x > 0 ? std::log((1 + s) / x) : 0.0;
    const double x3 = x * x * x, s3 = s * s * s;
    const double area = angle - x * s; // then with the weights rho, rho^2 and rho^4
    const double first = 2 * angle / 3 - x * s / 3 - x3 * log / 3;
    const double second = angle / 2 - x3 * s / 2 - x * s3 / 6;
    const double fourth = angle / 3 - x3 * x * x * s / 3 - 2 * x3 * s3 / 9 - x * s3 * s * s / 15;
    const auto bias = [&] {
        switch (filter) {
        case filter_kind::constant: return area;
        case filter_kind::cone: return 3 * (area - first);
        case filter_kind::epanechnikov: return 2 * (area - second);
        case filter_kind::silverman: break;
        }
        return 3 * (area - 2 * second + fourth);
    };
    return {2 * s3 / (3 * pi), (s - x * x * log - 8 * s3 / 9) / pi, (2 * second - area) / pi, bias() / pi};
}

/// The step whose jump is `ratio` of its tilt: 1/6 for one through the middle, -1/3 at the rim. Steps of many passes
/// with radii of their own add up to moments that are about those of one step, and so do their biases.
inline light_step step_of_ratio(double ratio, filter_kind filter)
{
    constexpr int steps = 256;
    static const auto tables = [] {
        std::array<std::array<light_step, steps>, filters.size()> all{};
        for (std::size_t f = 0; f < filters.size(); ++f)
            for (int i = 0; i < steps; ++i)
                all[f][static_cast<std::size_t>(i)] = step_at(static_cast<double>(i) / steps, filters[f].kind);
        return all;
    }();
    const auto& table = tables[static_cast<std::size_t>(filter)];
    // The ratio falls along the table.
    const auto after = std::partition_point(
        table.begin(), table.end(), [&](const light_step& at) { return at.jump > ratio * at.tilt; });
    if (after == table.begin())
        return table.front();
    if (after == table.end())
        return table.back();
    const auto &a = *(after - 1), &b = *after;
    const double of_a = a.jump / a.tilt, of_b = b.jump / b.tilt, part = (of_a - ratio) / (of_a - of_b);
    const auto between = [&](double u, double v) { return u + part * (v - u); };
    return {between(a.tilt, b.tilt), between(a.jump, b.jump), between(a.curve, b.curve), between(a.bias, b.bias)};
}

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
