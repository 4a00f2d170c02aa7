// The light of an environment for kernels: its texels, and the shares by which light is sampled from them.
#pragma once

#include <photongrid/scene/distant_lights.hpp>

#include <glm/vec4.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// As trace/environment.glsl and trace/lights/environment_light.glsl describe it; empty without an environment.
struct environment_layout {
    std::vector<glm::vec4> texels;     ///< row by row
    std::vector<std::uint32_t> shares; ///< of the rows, then of each row's texels
};

namespace detail {
    /// Appends the sums of weights up to each one, divided by the sum of all and times 2^24, to `out`. Each weight
    /// above 0 has at least 1 of them, because random numbers in single precision have 24 bits: what has light is
    /// sampled.
    inline void append_shares(std::vector<std::uint32_t>& out, const std::vector<double>& weights)
    {
        constexpr std::uint32_t all = 1u << 24;
        double total = 0;
        std::uint32_t lit = 0;
        for (const double w : weights) {
            total += w;
            lit += w > 0 ? 1 : 0;
        }
        const double rest = total > 0 ? (all - lit) / total : 0;
        double below = 0;
        std::uint32_t seen = 0;
        for (const double w : weights) {
            below += w;
            seen += w > 0 ? 1 : 0;
            out.push_back(seen == lit ? all : seen + static_cast<std::uint32_t>(below * rest));
        }
    }

    /// The share of element i of those that begin at `first`, 0 to 1.
    inline double share_at(const std::vector<std::uint32_t>& shares, std::size_t first, std::size_t i)
    {
        return (shares[first + i] - (i == 0 ? 0.0 : shares[first + i - 1])) / (1u << 24);
    }
} // namespace detail

/// Texels are sampled in proportion to their radiance (sum of rgb) and to their solid angle.
/// \throws std::invalid_argument for a radiance that does not fit single precision.
inline environment_layout lay_out(const environment_light& light)
{
    const environment_texels texels(light);
    const std::size_t width = texels.width(), height = texels.height();
    const auto radiance = [&](std::size_t column, std::size_t row) {
        return texels.radiance(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row));
    };
    std::vector<double> rows(height, 0), weights(width);
    const auto read_row = [&](std::size_t row) {
        double sum = 0;
        for (std::size_t column = 0; column < width; ++column) {
            const dvec3 l = radiance(column, row);
            sum += weights[column] = l.x + l.y + l.z;
        }
        return sum;
    };
    for (std::size_t row = 0; row < height; ++row)
        rows[row] = read_row(row) * texels.solid_angle(static_cast<std::uint32_t>(row));
    environment_layout out;
    out.shares.reserve(height * (width + 1));
    out.texels.reserve(width * height);
    detail::append_shares(out.shares, rows);
    for (std::size_t row = 0; row < height; ++row) {
        const std::size_t first = out.shares.size();
        read_row(row);
        detail::append_shares(out.shares, weights);
        const double of_row = detail::share_at(out.shares, 0, row);
        for (std::size_t column = 0; column < width; ++column) {
            // A texel is pi / height times 2 pi / width; its solid angle at a colatitude is that times the sine.
            const double density = of_row * detail::share_at(out.shares, first, column) * static_cast<double>(width)
                * static_cast<double>(height) / (2 * std::numbers::pi * std::numbers::pi);
            const glm::vec3 l(radiance(column, row));
            detail::require(std::isfinite(l.x) && std::isfinite(l.y) && std::isfinite(l.z),
                "environment_lights[0]: its radiance is too large for single precision; use smaller values");
            out.texels.emplace_back(l, static_cast<float>(density));
        }
    }
    return out;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
