// Whether two renderers give each material the same light, for devices whose pictures differ from serial's by rounding.
// Pictures of one seed have the same paths but for those that rounding sends elsewhere, so their differences are small,
// and an error of 1 % in one material stands out.
#pragma once

#include "pictures.hpp"

#include <photongrid/reference/intersect.hpp>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace photongrid::testing {

/// The material that the middle of each pixel shows, row by row; `nothing` where it shows none, a lamp, or an edge,
/// which rounding moves to one side or the other.
inline std::vector<std::uint32_t> materials_seen(const scene& s, std::uint32_t width, std::uint32_t height)
{
    const reference::geometry all(s);
    const detail::camera_axes axes(s.camera);
    const double half = std::tan(s.camera.vertical_fov * M_PI / 360);
    const auto seen_at = [&](double x, double y) {
        const double right = (2 * x - width) / height * half, up = (height - 2 * y) / height * half;
        return all.nearest({s.camera.position, glm::normalize(axes.forward + right * axes.right + up * axes.up)});
    };
    std::vector<std::uint32_t> seen;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const auto h = seen_at(x + 0.5, y + 0.5);
            bool plain = h.shape != reference::nothing && h.light == reference::nothing;
            for (const double beside : {-1e-3, 1e-3})
                plain = plain && seen_at(x + 0.5 + beside, y + 0.5).shape == h.shape
                    && seen_at(x + 0.5, y + 0.5 + beside).shape == h.shape;
            seen.push_back(plain ? h.material : static_cast<std::uint32_t>(reference::nothing));
        }
    return seen;
}

/// The t for which P(|T| > t) = alpha, T of Student's distribution, by Simpson's rule and bisection.
inline double student_limit(double alpha, int degrees)
{
    const double n = degrees;
    const auto density = [n](double x) {
        return std::tgamma((n + 1) / 2) / (std::sqrt(n * M_PI) * std::tgamma(n / 2))
            * std::pow(1 + x * x / n, -(n + 1) / 2);
    };
    const auto tail = [&](double t) { // x = 1 / u reaches infinity
        const int steps = 2000;
        const double h = 1 / (t * steps);
        const auto at = [&](int i) { return i == 0 ? 0.0 : density(1 / (i * h)) / (i * h * i * h); };
        double sum = at(0) + at(steps);
        for (int i = 1; i < steps; ++i)
            sum += at(i) * (i % 2 == 1 ? 4 : 2);
        return 2 * sum * h / 3;
    };
    double low = 1e-3, high = 1e6;
    for (int i = 0; i < 200; ++i)
        (tail(std::sqrt(low * high)) > alpha ? low : high) = std::sqrt(low * high);
    return high;
}

/// The light of a material in one channel and part of the light: how much brighter `mine` draws it than `theirs`.
struct material_difference {
    std::string what;
    double mean = 0; ///< relative, over the seeds
    double limit
        = 0; ///< what |mean| stays below with a probability of 99 % for all materials together, if none differs
    bool stands_out() const { return !(std::abs(mean) <= limit); }
};

/// Draws a scene with these settings.
using drawing = std::function<image(const scene&, const render_settings&)>;

/// Compares the light of each material of `s`, all and the indirect alone, over eight seeds.
inline std::vector<material_difference> differences_by_material(
    const scene& s, const scene& other, const drawing& mine, const drawing& theirs)
{
    constexpr int seeds = 8;
    const auto& size = s.render.output;
    const auto seen = materials_seen(s, size.width, size.height);
    const auto sums = [&](const image& im) {
        std::vector<dvec3> light(s.materials.size(), dvec3(0));
        for (std::size_t i = 0; i < seen.size(); ++i)
            if (seen[i] < light.size())
                light[seen[i]] += dvec3(im.pixels[i]);
        return light;
    };
    std::vector<material_difference> all;
    for (const auto part : {light_part::all, light_part::indirect}) {
        std::vector<std::vector<dvec3>> a, b;
        for (int seed = 0; seed < seeds; ++seed) {
            auto settings = s.render;
            settings.seed = 100 + static_cast<std::uint32_t>(seed);
            settings.output.only = part;
            a.push_back(sums(mine(other, settings)));
            b.push_back(sums(theirs(s, settings)));
        }
        for (std::size_t m = 0; m < s.materials.size(); ++m)
            for (int c = 0; c < 3; ++c) {
                double light = 0, mean = 0, variance = 0;
                for (const auto& pixels : b)
                    light += pixels[m][c] / seeds;
                if (light <= 0)
                    continue; // not seen, or black
                std::vector<double> d;
                for (std::size_t i = 0; i < seeds; ++i)
                    d.push_back((a[i][m][c] - b[i][m][c]) / light);
                for (const double x : d)
                    mean += x / seeds;
                for (const double x : d)
                    variance += (x - mean) * (x - mean) / (seeds - 1);
                all.push_back({s.materials[m].name + ", channel " + std::to_string(c)
                        + (part == light_part::all ? "" : ", indirect"),
                    mean, std::sqrt(variance / seeds)});
            }
    }
    const double t = student_limit(0.01 / static_cast<double>(all.size()), seeds - 1);
    for (auto& d : all)
        d.limit = t * d.limit + 1e-6; // the sums' own rounding
    return all;
}

} // namespace photongrid::testing
