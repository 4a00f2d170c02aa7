#include <photongrid/compare/error_map.hpp>
#include <photongrid/compare/image_difference.hpp>
#include <photongrid/scene/check.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace photongrid {

double luminance_of(const glm::vec3& linear)
{
    const glm::dvec3 c(linear);
    return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

double pixel_error::brighter() const { return (luminance - reference) / (reference + relmse_floor); }

std::vector<pixel_error> pixel_errors(const image& a, const image& b)
{
    detail::require_same_size(a, b);
    std::vector<pixel_error> errors;
    errors.reserve(a.pixels.size());
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::dvec3 p(a.pixels[i]), q(b.pixels[i]);
        if (!detail::finite(p) || !detail::finite(q)) {
            errors.push_back({.relative = std::numeric_limits<double>::quiet_NaN()});
            continue;
        }
        double squares = 0;
        for (int c = 0; c < 3; ++c) {
            const double relative = (p[c] - q[c]) / (q[c] + relmse_floor);
            squares += relative * relative;
        }
        errors.push_back({std::sqrt(squares / 3), luminance_of(a.pixels[i]), luminance_of(b.pixels[i])});
    }
    return errors;
}

namespace {
    /// The mean square of the sorted errors without the largest.
    double trimmed_mean(std::span<const double> sorted)
    {
        const auto largest = static_cast<std::size_t>(std::ceil(trimmed_share * static_cast<double>(sorted.size())));
        const auto kept = sorted.first(std::max(sorted.size() - largest, std::min<std::size_t>(sorted.size(), 1)));
        double sum = 0;
        for (const double e : kept)
            sum += e * e;
        return sum / static_cast<double>(kept.size());
    }
} // namespace

error_summary summary_of(
    std::span<const pixel_error> errors, std::span<const float> visible, const picture_region& region)
{
    error_summary s;
    std::vector<double> sorted;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const auto& e = errors[i];
        if (!region.pixels[i] || !std::isfinite(e.relative))
            continue;
        sorted.push_back(e.relative);
        s.squares += e.relative * e.relative;
        s.mean += e.luminance;
        s.reference_mean += e.reference;
        s.flip += static_cast<double>(visible[i]);
    }
    s.pixels = sorted.size();
    const auto count = static_cast<double>(s.pixels);
    s.relmse = s.squares / count; // NaN for none, as all that follows
    s.mean /= count;
    s.reference_mean /= count;
    s.flip /= count;
    std::sort(sorted.begin(), sorted.end());
    s.trimmed_relmse = trimmed_mean(sorted);
    for (std::size_t i = 0; i < error_percentiles.size(); ++i) {
        const auto rank = (sorted.size() * static_cast<std::size_t>(error_percentiles[i]) + 99) / 100;
        s.percentiles[i] = rank > 0 ? sorted[rank - 1] : std::numeric_limits<double>::quiet_NaN();
    }
    return s;
}

std::vector<error_bin> error_histogram(std::span<const pixel_error> errors)
{
    std::vector<error_bin> bins{{.from = 0, .to = 0}};
    for (int half_decade = -8; half_decade <= 4; ++half_decade) {
        const double edge = std::pow(10.0, half_decade / 2.0);
        bins.back().to = edge;
        bins.push_back({.from = edge, .to = std::numeric_limits<double>::infinity()});
    }
    for (const auto& e : errors) {
        if (!std::isfinite(e.relative))
            continue;
        auto bin = bins.begin();
        while (e.relative >= bin->to)
            ++bin;
        ++bin->pixels;
        bin->squares += e.relative * e.relative;
    }
    return bins;
}

} // namespace photongrid
